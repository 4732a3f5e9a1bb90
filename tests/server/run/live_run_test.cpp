// Runs that fly a live vehicle: its messages come over the loopback interface.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <set>
#include <span>
#include <thread>
#include <vector>

#include "core/outside/file_descriptor.hpp"
#include "flight/mavlink/frame.hpp"
#include "flight/mavlink/frame_finder.hpp"
#include "flight/mavlink/payload.hpp"
#include "server/camera/truth.hpp"
#include "server/record/run_info_file.hpp"
#include "server/run/run.hpp"
#include "server/scenario/document/estimators/estimator_reach.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/timeline/run_timeline.hpp"
#include "tests/server/support/server_fixture.hpp"

namespace overfly::server {
namespace {

using flight::mavlink::PayloadWriter;
using overfly::testing::TemporaryFolder;
using ::testing::HasSubstr;
using testing::noop_factory;
using testing::options_for;
using testing::small_scenario;

/// Sends heartbeats, attitudes and positions at 50 Hz of its own clock, which runs about 20 times
/// as fast as the machine's, to the first connection, then disarms.
class StreamingVehicle {
 public:
  /// @param pause_ms  of the machine's clock between samples that are 20 ms apart
  /// @param north_m_s  its speed
  explicit StreamingVehicle(double seconds, int pause_ms = 1, double north_m_s = 0.0)
      : seconds_(seconds), pause_ms_(pause_ms), north_m_s_(north_m_s) {
    listener_ = FileDescriptor(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in name{};
    name.sin_family = AF_INET;
    name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof name;
    auto* const address = reinterpret_cast<sockaddr*>(&name);
    EXPECT_EQ(::bind(listener_.get(), address, size), 0);
    EXPECT_EQ(::listen(listener_.get(), 1), 0);
    ::getsockname(listener_.get(), address, &size);
    port_ = ntohs(name.sin_port);
    thread_ = std::thread([this] { run(); });
  }
  ~StreamingVehicle() {
    ::shutdown(listener_.get(), SHUT_RDWR);
    if (thread_.joinable()) thread_.join();
  }
  [[nodiscard]] std::string link() const { return "tcp:127.0.0.1:" + std::to_string(port_); }
  /// All that the run sent, after its end.
  [[nodiscard]] const std::vector<std::uint8_t>& received() {
    thread_.join();
    return received_;
  }

 private:
  void run() {
    FileDescriptor peer(::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    const auto end_ms = static_cast<std::uint32_t>(5000 + 1000 * seconds_);
    for (std::uint32_t ms = 5000; ms <= end_ms; ms += 20) {
      if (!send(peer, 0, heartbeat(true)) || !send(peer, 30, attitude_at(ms)) ||
          !send(peer, 33, position_at(ms))) {
        return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(pause_ms_));
    }
    (void)send(peer, 0, heartbeat(false));
    // Until the run has ended.
    std::array<std::uint8_t, 4096> bytes{};
    for (ssize_t got = 1; got > 0;) {
      got = ::recv(peer.get(), bytes.data(), bytes.size(), 0);
      if (got > 0) received_.insert(received_.end(), bytes.begin(), bytes.begin() + got);
    }
  }
  static std::vector<std::uint8_t> heartbeat(bool armed) {
    return PayloadWriter(9)
        .put(4, std::uint8_t{1})
        .put(5, std::uint8_t{3})
        .put(6, static_cast<std::uint8_t>(armed ? 0x81 : 0x01))
        .bytes();
  }
  static std::vector<std::uint8_t> attitude_at(std::uint32_t ms) {
    return PayloadWriter(28).put(0, ms).put(12, 1.5F).bytes();
  }
  /// 300 m above sea level, at the built-in world's place at first.
  [[nodiscard]] std::vector<std::uint8_t> position_at(std::uint32_t ms) const {
    constexpr double kMetresPerStep = 0.011132;  // of 1e-7 deg of latitude, to 0.3 %
    const double north_m = north_m_s_ * 1e-3 * (ms - 5000.0);
    return PayloadWriter(28)
        .put(0, ms)
        .put(4, static_cast<std::int32_t>(392345678 + std::lround(north_m / kMetresPerStep)))
        .put(20, static_cast<std::int16_t>(std::lround(100.0 * north_m_s_)))
        .put(8, std::int32_t{-861234567})
        .put(12, std::int32_t{300000})
        .bytes();
  }
  bool send(const FileDescriptor& peer, std::uint32_t id, std::vector<std::uint8_t> payload) {
    const auto bytes = flight::mavlink::encode_frame(
        {flight::mavlink::Version::kTwo, sequence_++, 1, 1, id, false, payload});
    return ::send(peer.get(), bytes->data(), bytes->size(), MSG_NOSIGNAL) ==
           static_cast<ssize_t>(bytes->size());
  }

  double seconds_;
  int pause_ms_;
  double north_m_s_;
  std::vector<std::uint8_t> received_;
  FileDescriptor listener_;
  std::uint16_t port_ = 0;
  std::uint8_t sequence_ = 0;
  std::thread thread_;
};

Scenario live_scenario(const StreamingVehicle& vehicle, const std::string& estimators = "[]") {
  return small_scenario({"flight.mavlink.link=" + vehicle.link(),
                         "flight.mavlink.read_only=true",
                         "estimators=" + estimators});
}

TEST(LiveRun, RecordsModesAndTheVehiclesState) {
  const StreamingVehicle vehicle(6.0);
  const TemporaryFolder folder;
  Scenario scenario = live_scenario(vehicle);
  scenario.duration_s.reset();
  const auto run = run_scenario(scenario, options_for(folder.path() / "r"));
  ASSERT_TRUE(run.ok()) << run.error().message;
  const auto timeline = RunTimeline::open(folder.path() / "r");
  ASSERT_TRUE(timeline) << timeline.error().message;
  const std::vector<VehicleStatus> statuses = (*timeline)->vehicle_statuses(0, 1000);
  ASSERT_GE(statuses.size(), 2U);
  EXPECT_EQ(statuses.front().t_ns, 0);
  for (std::size_t i = 1; i < statuses.size(); ++i) {
    const std::int64_t step_ns = statuses[i].t_ns - statuses[i - 1].t_ns;
    EXPECT_GT(step_ns, 300'000'000);
    EXPECT_LE(step_ns, 700'000'000);
  }
  EXPECT_EQ(statuses.front().vehicle, "1.1");
  EXPECT_EQ(statuses.front().mode, "MANUAL");
  EXPECT_EQ(statuses.front().armed, true);
  EXPECT_FALSE(statuses.front().battery_v);
  EXPECT_EQ(statuses.back().lost_messages, 0U);
  std::vector<std::string> modes;
  std::vector<std::string> others;
  for (const LogRow& row : (*timeline)->logs(0, 1000)) {
    if (row.kind == "mode") modes.push_back(row.text);
    if (row.kind == "event") others.push_back(row.text);
  }
  EXPECT_EQ(modes, std::vector<std::string>{"MANUAL"});
  // What ended the flight came after its last frame.
  EXPECT_THAT(others, ::testing::Contains("disarmed"));
}

TEST(LiveRun, FliesAVehicleUntilItIsDisarmed) {
  const StreamingVehicle vehicle(10.0);
  const TemporaryFolder folder;
  Scenario scenario = live_scenario(vehicle, R"([{"name":"p","type":"perfect"}])");
  scenario.duration_s.reset();
  const auto run = run_scenario(scenario, options_for(folder.path() / "r"));
  ASSERT_TRUE(run.ok()) << run.error().message;
  // Time 0 is when the run begins to listen, some time after the vehicle began to send.
  EXPECT_GT(run->info.frames, 30);
  EXPECT_LE(run->info.frames, 101);
  const std::string manifest = overfly::testing::read_text(folder.path() / "r" / "manifest.json");
  EXPECT_THAT(manifest,
              HasSubstr("live vehicle 1.1 on " + vehicle.link() +
                        ": the estimate (1.1/GLOBAL_POSITION_INT, 1.1/ATTITUDE)"));
  EXPECT_THAT(manifest, HasSubstr(" s: the vehicle was disarmed"));
}

TEST(LiveRun, SendsTheEstimatesToTheVehicle) {
  StreamingVehicle vehicle(3.0, 20);
  const TemporaryFolder folder;
  Scenario scenario = small_scenario(
      {"flight.mavlink.link=" + vehicle.link(),
       R"(estimators=[{"name":"p","type":"perfect"},{"name":"q","type":"perfect"}])",
       R"(flight.mavlink.feedback={"estimator":"p","message":"gps_input","send_height":true})",
       "flight.mavlink.rate_hz=0"});
  ASSERT_EQ(scenario.feedback_estimator, 0U);
  scenario.duration_s.reset();
  const auto run = run_scenario(scenario, options_for(folder.path() / "r"));
  ASSERT_TRUE(run.ok()) << run.error().message;
  flight::mavlink::FrameFinder finder;
  std::span<const std::uint8_t> rest = vehicle.received();
  std::set<std::uint64_t> stamps_us;
  while (true) {
    const auto found = finder.next(rest, true);
    if (!found.frame) break;
    rest = rest.subspan(found.consumed_bytes);
    if (found.frame->message_id != 232) continue;
    const flight::mavlink::PayloadReader payload(found.frame->payload);
    stamps_us.insert(payload.at<std::uint64_t>(0));
    // The vehicle's own place, within the rounding of 1e-7 deg and of the world's frame.
    EXPECT_NEAR(payload.at<std::int32_t>(12), 392345678, 2);
    EXPECT_NEAR(payload.at<std::int32_t>(16), -861234567, 2);
    EXPECT_NEAR(payload.at<float>(20), 300.0, 0.02);
  }
  ASSERT_FALSE(stamps_us.empty());
  // Captures lie on the camera's grid from some sample of the vehicle's clock, 20 ms apart, on.
  const double period_us = 1e6 / scenario.rate.hz();
  for (const std::uint64_t stamp_us : stamps_us) {
    const auto since_first = static_cast<double>(stamp_us - *stamps_us.begin());
    EXPECT_NEAR(std::remainder(since_first, period_us), 0.0, 1.5);
    EXPECT_GE(stamp_us, 5'000'000U);
    EXPECT_LE(stamp_us, 8'000'000U);
  }
  const std::string log = overfly::testing::read_text(folder.path() / "r" / "log.jsonl");
  EXPECT_THAT(log,
              HasSubstr("sent " + std::to_string(stamps_us.size()) +
                        " GPS_INPUT to vehicle 1.1, the oldest "));
  const std::string timings = overfly::testing::read_text(folder.path() / "r" / "timings.json");
  EXPECT_THAT(timings, HasSubstr("message_to_frame"));
}

TEST(LiveRun, ChecksTheFeedbackOfItsScenario) {
  const auto refused = [](const std::string& feedback, const std::string& more = "") {
    std::vector<std::string> changes = {"flight.mavlink.link=tcp:127.0.0.1:1",
                                        R"(estimators=[{"name":"p","type":"perfect"}])",
                                        "flight.mavlink.feedback=" + feedback};
    if (!more.empty()) changes.push_back(more);
    try {
      (void)small_scenario(changes);
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refused(R"({"estimator":"p","message":"odometry","latency_ms":400})"), "accepted");
  EXPECT_THAT(refused(R"({"estimator":"p","message":"odometry","latency_ms":401})"),
              HasSubstr("flight.mavlink.feedback.latency_ms = 401: must be in [0, 400]"));
  EXPECT_THAT(refused(R"({"estimator":"r","message":"odometry"})"),
              HasSubstr("flight.mavlink.feedback.estimator = r: must be the name of one of the "
                        "scenario's estimators: p"));
  EXPECT_THAT(refused(R"({"estimator":"p","message":"odometry","position_std_dev_m":1})"),
              HasSubstr("must be given together"));
  EXPECT_THAT(refused(R"({"estimator":"p","message":"odometry"})", "flight.mavlink.read_only=true"),
              HasSubstr("flight.mavlink.feedback: must not be given with read_only = true"));
}

TEST(LiveRun, FliesInRealTime) {
  const StreamingVehicle vehicle(4.0, 20);
  const TemporaryFolder folder;
  Scenario scenario = live_scenario(vehicle);
  scenario.pacing = Pacing::kRealTime;
  scenario.duration_s.reset();
  const auto run = run_scenario(scenario, options_for(folder.path() / "r"));
  ASSERT_TRUE(run.ok()) << run.error().message;
  EXPECT_GT(run->info.frames, 0);
  EXPECT_THAT(overfly::testing::read_text(folder.path() / "r" / "timings.json"),
              HasSubstr("message_to_frame"));
}

TEST(LiveRun, InRealTimeBeginsWithTheLatestStateAlsoWithALimitedDuration) {
  constexpr double kSpeedMS = 25.0;
  const StreamingVehicle vehicle(20.0, 20, kSpeedMS);
  const TemporaryFolder folder;
  Scenario scenario = live_scenario(vehicle);
  scenario.pacing = Pacing::kRealTime;
  scenario.duration_s = 1.5;
  RunOptions options = options_for(folder.path() / "r");
  // A slow set-up: the vehicle flies on meanwhile.
  options.renderer_factory = [make = options.renderer_factory](auto&&... arguments) {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    return make(std::forward<decltype(arguments)>(arguments)...);
  };
  const auto run = run_scenario(scenario, options);
  ASSERT_TRUE(run.ok()) << run.error().message;
  const auto timeline = RunTimeline::open(folder.path() / "r");
  ASSERT_TRUE(timeline) << timeline.error().message;
  const std::vector<FrameRow> frames = (*timeline)->frames(0, 100);
  ASSERT_GE(frames.size(), 2U);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const double expected_m = kSpeedMS * s_from_ns(frames[i].t_ns - frames[i - 1].t_ns);
    const Eigen::Vector3d step =
        frames[i].T_world_body.translation - frames[i - 1].T_world_body.translation;
    EXPECT_NEAR(step.norm(), expected_m, 0.2) << "frame " << frames[i].frame;
  }
}

TEST(LiveRun, EndsWhenItsScenarioSays) {
  const StreamingVehicle vehicle(20.0);
  const TemporaryFolder folder;
  const auto run = run_scenario(live_scenario(vehicle), options_for(folder.path() / "r"));
  ASSERT_TRUE(run.ok()) << run.error().message;
  EXPECT_EQ(run->info.frames, 21);  // duration_s = 2
}

TEST(LiveRun, FailsWithTheFieldWhenNobodyAnswers) {
  const TemporaryFolder folder;
  const Scenario scenario =
      small_scenario({"flight.mavlink.link=tcp:127.0.0.1:1", "flight.mavlink.patience_s=0.2"});
  const auto run = run_scenario(scenario, options_for(folder.path() / "r"));
  ASSERT_FALSE(run.ok());
  EXPECT_THAT(run.error().message,
              HasSubstr("flight.mavlink: tcp:127.0.0.1:1: no heartbeat of an autopilot within"));
}

TEST(LiveRun, IsNeverFlownAgain) {
  const TemporaryFolder empty;
  const Scenario scenario = small_scenario({"flight.mavlink.link=tcp:127.0.0.1:1"});
  const auto world = terrain::World();
  const auto again = open_flown_truth(empty.path(), {}, scenario, world);
  ASSERT_FALSE(again.ok());
  EXPECT_EQ(again.error().code, ErrorCode::kNotFound);
}

TEST(LiveScenario, NamesTheFieldsThatAreWrong) {
  const auto message_of = [](std::vector<std::string> overrides) {
    overrides.insert(overrides.begin(), "flight.mavlink.link=tcp:127.0.0.1:5760");
    try {
      (void)small_scenario(overrides);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message_of({}), "");
  EXPECT_EQ(message_of({"flight.mavlink.parameters.SIM_SPEEDUP=5"}), "");
  EXPECT_THAT(message_of({"flight.mavlink.link=tcp:example.org:1"}),
              HasSubstr("flight.mavlink.link = 'tcp:example.org:1': the host must be"));
  EXPECT_THAT(message_of({"flight.mavlink.rate_hz=2000"}),
              HasSubstr("flight.mavlink.rate_hz = 2000"));
  EXPECT_THAT(message_of({"flight.mavlink.read_only=true", "flight.mavlink.arm_and_start=true"}),
              HasSubstr("flight.mavlink.arm_and_start: must not be given with read_only"));
  EXPECT_THAT(message_of({R"(flight.mavlink.parameters={"a name":1})"}),
              HasSubstr("letters, digits or underscores"));
  EXPECT_THAT(message_of({"flight.mavlink.sistem=1"}), HasSubstr("no such field"));
}

TEST(LiveScenario, ConnectsOnlyWhereTheOperatorAllows) {
  const Scenario course = small_scenario();
  const Scenario live = small_scenario({"flight.mavlink.link=udp-listen:localhost:14550"});
  EXPECT_TRUE(check_link(course, {}).ok());
  EXPECT_THAT(check_link(live, {}).error().message,
              HasSubstr("flight.mavlink.link = udp-listen:127.0.0.1:14550: the server was not "
                        "started with --allow-link udp-listen:127.0.0.1:14550"));
  EXPECT_TRUE(check_link(live, {"udp-listen:127.0.0.1:14550"}).ok());
  EXPECT_FALSE(check_link(live, {"udp-listen:127.0.0.1:14551"}).ok());

  // What the scenario's file does may be done, nothing else.
  EXPECT_TRUE(check_reach(live, {live}).ok());
  EXPECT_THAT(check_reach(live, {course}).error().message,
              HasSubstr("flight.mavlink: must be as in the scenario's file"));
  const Scenario arming = small_scenario(
      {"flight.mavlink.link=udp-listen:localhost:14550", "flight.mavlink.arm_and_start=true"});
  EXPECT_FALSE(check_reach(arming, {live}).ok());
  EXPECT_TRUE(check_reach(course, {live}).ok());
}

}  // namespace
}  // namespace overfly::server
