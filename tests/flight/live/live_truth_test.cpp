// The flight of a vehicle over the loopback interface, recorded and made by hand.
#include "flight/live/live_truth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <thread>

#include "flight/logs/log_trajectory.hpp"
#include "flight/logs/ned_attitude.hpp"
#include "flight/mavlink/link/frame_recorder.hpp"
#include "flight/mavlink/payload.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/flight/mavlink/link/peer_socket.hpp"
#include "tests/flight/mavlink/replay_vehicle.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::live {
namespace {

using mavlink::PayloadWriter;
using mavlink::Vehicle;
using std::chrono::milliseconds;
using testing::append;
using testing::Bytes;
using ::testing::ElementsAre;
using testing::frame_bytes;
using ::testing::HasSubstr;
using testing::PeerSocket;

constexpr double kLat0 = -35.363262;
constexpr double kLon0 = 149.165237;

LocalFrame frame_at_start() { return LocalFrame(geodetic_from_deg(kLat0, kLon0, 600.0)); }

std::shared_ptr<Vehicle> listening_vehicle(
    const std::string& address, std::shared_ptr<mavlink::FrameRecorder> recorder = nullptr) {
  mavlink::VehicleOptions options;
  options.link.recorder = std::move(recorder);
  options.link.read_only = true;
  Result<std::unique_ptr<Vehicle>> opened =
      Vehicle::open(*mavlink::parse_link_address(address, "link"), options);
  EXPECT_TRUE(opened.ok()) << opened.error().message;
  return std::move(*opened);
}

/// A vehicle that flies north at 25 m/s and turns its yaw, with its messages made by hand.
class MadeVehicle {
 public:
  explicit MadeVehicle(std::uint16_t port) { EXPECT_TRUE(socket_.connect_to(port)); }

  void send(const Bytes& frame) { EXPECT_TRUE(socket_.send(frame)); }
  void heartbeat(bool armed = true) {
    send(frame_bytes(0,
                     PayloadWriter(9)
                         .put(0, std::uint32_t{10})
                         .put(4, std::uint8_t{1})
                         .put(5, std::uint8_t{3})
                         .put(6, static_cast<std::uint8_t>(armed ? 0x81 : 0x01))
                         .bytes(),
                     sequence_++));
  }
  void attitude(std::uint32_t boot_ms) {
    send(frame_bytes(
        30, testing::attitude_payload(boot_ms, 0.0F, 0.0F, yaw_at(boot_ms)), sequence_++));
  }
  void position(std::uint32_t boot_ms) {
    Bytes payload;
    testing::put(payload, boot_ms);
    testing::put(payload, lat_at(boot_ms));
    testing::put(payload, static_cast<std::int32_t>(std::lround(kLon0 * 1e7)));
    for (const std::int32_t alt_mm : {600000, 300000}) testing::put(payload, alt_mm);
    for (const std::int16_t value : {2500, 0, 0, 0}) testing::put(payload, value);
    send(frame_bytes(33, payload, sequence_++));
  }
  /// SIM_STATE 100 m above the estimate; it has no time.
  void sim_state(std::uint32_t boot_ms) {
    PayloadWriter payload(92);
    payload.put(0, 1.0F).put(60, 700.0F).put(72, 25.0F);
    payload.put(84, lat_at(boot_ms));
    payload.put(88, static_cast<std::int32_t>(std::lround(kLon0 * 1e7)));
    send(frame_bytes(108, payload.bytes(), sequence_++));
  }
  void state(std::uint32_t boot_ms) {
    attitude(boot_ms);
    position(boot_ms);
  }
  static float yaw_at(std::uint32_t boot_ms) {
    return 0.1e-3F * static_cast<float>(boot_ms % 10000);
  }
  static std::int32_t lat_at(std::uint32_t boot_ms) {
    // 0.011131884502145034 m per 1e-7 deg.
    return static_cast<std::int32_t>(std::lround(kLat0 * 1e7 + 0.025 * boot_ms / 0.0111318845));
  }

 private:
  PeerSocket socket_{SOCK_DGRAM};
  std::uint8_t sequence_ = 0;
};

struct OpenedTruth {
  std::shared_ptr<Vehicle> vehicle;
  std::unique_ptr<MadeVehicle> made;
  std::unique_ptr<LiveTruth> truth;

  explicit OpenedTruth(LiveTruthOptions options = {}) {
    vehicle = listening_vehicle("udp-listen:127.0.0.1:0", options.recorder);
    made = std::make_unique<MadeVehicle>(vehicle->address().port);
    made->heartbeat();
    options.simulation_wait_ns = std::min(options.simulation_wait_ns, kNsPerS / 10);
    // Messages that were sent before the listener is set are lost to it: the vehicle goes on.
    std::atomic<bool> opened{false};
    std::thread flying([&] {
      for (std::uint32_t ms = 10000; !opened && ms < 60000; ms += 20) {
        made->state(ms);
        last_ms = ms;
        std::this_thread::sleep_for(milliseconds(1));
      }
    });
    Result<std::unique_ptr<LiveTruth>> result =
        LiveTruth::open(vehicle, frame_at_start(), options, nullptr);
    opened = true;
    flying.join();
    EXPECT_TRUE(result.ok()) << result.error().message;
    if (result.ok()) truth = std::move(*result);
  }
  /// A time of the vehicle's clock as a time of the flight.
  [[nodiscard]] std::int64_t flight_ns(std::uint32_t boot_ms) const {
    return std::int64_t{boot_ms} * 1'000'000 - truth->start_ns();
  }
  /// Sends states every 20 ms of the vehicle's clock, as fast as the session takes them: a socket
  /// holds some hundred messages.
  void fly_until(std::uint32_t boot_ms) {
    while (last_ms < boot_ms) {
      last_ms += 20;
      made->state(last_ms);
      if (last_ms % 500 < 20 || last_ms >= boot_ms) wait_for_session();
    }
  }
  void wait_for_session() const {
    const std::int64_t sent_ns = std::int64_t{last_ms} * 1'000'000;
    for (int i = 0; i < 5000 && vehicle->state().boot_ns.value_or(0) < sent_ns; ++i) {
      std::this_thread::sleep_for(milliseconds(1));
    }
  }
  std::uint32_t last_ms = 0;
};

TEST(LiveTruth, FliesTheEstimateByTheVehiclesClock) {
  OpenedTruth live;
  ASSERT_NE(live.truth, nullptr);
  EXPECT_THAT(live.truth->description(),
              HasSubstr("the estimate (1.1/GLOBAL_POSITION_INT, 1.1/ATTITUDE)"));
  live.fly_until(70000);
  const std::uint32_t asked_ms = live.last_ms - 500 + 7;  // between two samples
  const auto state = live.truth->state_at(live.flight_ns(asked_ms));
  ASSERT_TRUE(state.ok()) << state.error().message;
  ASSERT_TRUE(state->has_value());
  // ArduPilot's metres are not those of the ellipsoid: compared through the latitude.
  const Eigen::Vector3d expected = frame_at_start().world_from_geodetic(
      geodetic_from_deg(kLat0 + 1e-7 * 0.025 * asked_ms / 0.0111318845, kLon0, 600.0));
  EXPECT_LT(((*state)->T_world_body.translation - expected).norm(), 0.02);  // steps of 1e-7 deg
  EXPECT_LT(((*state)->v_body_world_m_s - Eigen::Vector3d(0, 25, 0)).norm(), 0.5);
  EXPECT_NEAR(
      attitude_from((*state)->T_world_body.rotation).yaw_rad, MadeVehicle::yaw_at(asked_ms), 1e-5);
  EXPECT_EQ((*state)->t_ns, live.flight_ns(asked_ms));
  EXPECT_THAT(live.truth->warnings(), ElementsAre());
}

TEST(LiveTruth, IsFlownAgainFromItsRecording) {
  const overfly::testing::TemporaryFolder folder;
  const auto tlog = folder.path() / "vehicle.tlog";
  auto recorder = mavlink::FrameRecorder::create(tlog);
  ASSERT_TRUE(recorder.ok()) << recorder.error().message;
  LiveTruthOptions options;
  options.recorder = std::move(*recorder);
  std::map<std::int64_t, Pose> flown;  // by the vehicle's clock
  {
    OpenedTruth live(options);
    ASSERT_NE(live.truth, nullptr);
    live.fly_until(live.last_ms + 3000);
    for (std::int64_t t_ns = live.truth->start_ns(); t_ns <= std::int64_t{live.last_ms} * 1'000'000;
         t_ns += 20'000'000) {
      const auto state = live.truth->state_at(t_ns - live.truth->start_ns());
      ASSERT_TRUE(state.ok() && *state);
      flown[t_ns] = (*state)->T_world_body;
    }
    EXPECT_THAT(live.truth->warnings(), ElementsAre());
  }
  options.recorder.reset();  // the last messages are in the file now
  const auto log = logs::open_log(tlog);
  ASSERT_TRUE(log.ok()) << log.error().message;
  const auto again = logs::read_log_trajectory(*log, {"", flown.begin()->first, {}}, nullptr);
  ASSERT_TRUE(again.ok()) << again.error().message;
  const LocalFrame frame = frame_at_start();
  std::size_t compared = 0;
  for (const logs::LogPose& pose : again->poses) {
    const auto then = flown.find(pose.t_ns);
    if (then == flown.end()) continue;
    ++compared;
    const Geodetic point =
        geodetic_from_deg(pose.position.x(), pose.position.y(), pose.position.z());
    EXPECT_LT((frame.world_from_geodetic(point) - then->second.translation).norm(), 1e-9);
    const Eigen::Quaterniond R = frame.R_world_enu_at(point) * logs::R_enu_ned() * pose.R_ned_body;
    EXPECT_LT(rotation_angle_rad(R, then->second.rotation), 1e-7);
  }
  EXPECT_GE(compared, 150U);
}

TEST(LiveTruth, PrefersTheSimulatorsState) {
  const auto vehicle = listening_vehicle("udp-listen:127.0.0.1:0");
  MadeVehicle made(vehicle->address().port);
  std::atomic<bool> opened{false};
  std::thread flying([&] {
    made.heartbeat();
    for (std::uint32_t ms = 10000; !opened && ms < 60000; ms += 20) {
      made.state(ms);
      // Later than the estimate, within the time that is waited for it.
      if (ms > 11000) made.sim_state(ms);
      std::this_thread::sleep_for(milliseconds(1));
    }
  });
  LiveTruthOptions options;
  options.geoid_separation_m = 20.0;
  auto truth = LiveTruth::open(vehicle, frame_at_start(), options, nullptr);
  opened = true;
  flying.join();
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  EXPECT_THAT((*truth)->description(), HasSubstr("the simulator's state (1.1/SIM_STATE)"));
  const auto state = (*truth)->state_at(0);
  ASSERT_TRUE(state.ok() && *state);
  const Geodetic point = frame_at_start().geodetic_from_world((*state)->T_world_body.translation);
  EXPECT_NEAR(point.alt_ellipsoid_m, 720.0, 1e-3);  // 700 m above the geoid
}

TEST(LiveTruth, ReportsGapsAndInterpolatesThem) {
  OpenedTruth live;
  ASSERT_NE(live.truth, nullptr);
  const std::uint32_t gap_ms = live.last_ms;
  live.last_ms += 3000;
  live.made->state(live.last_ms);
  const std::uint32_t asked_ms = gap_ms + 1500;
  const auto state = live.truth->state_at(live.flight_ns(asked_ms));
  ASSERT_TRUE(state.ok() && *state);
  const Eigen::Vector3d expected = frame_at_start().world_from_geodetic(
      geodetic_from_deg(1e-7 * MadeVehicle::lat_at(asked_ms), kLon0, 600.0));
  // The Hermite polynomial of a straight flight is straight. ArduPilot's metres differ by 0.3 %.
  EXPECT_LT(((*state)->T_world_body.translation - expected).norm(), 0.1);
  const std::vector<std::string> warnings = live.truth->warnings();
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_THAT(warnings[0], HasSubstr("gaps between samples are longer than 0.500 s"));
  EXPECT_THAT(warnings[0], HasSubstr("is 3.000 s long"));
}

TEST(LiveTruth, TakesLateAndDoubleMessagesInTheirOrder) {
  OpenedTruth live;
  ASSERT_NE(live.truth, nullptr);
  const std::uint32_t begin_ms = live.last_ms;
  for (const std::uint32_t ms : {40U, 20U, 20U, 60U, 40U, 100U, 80U}) {
    live.made->state(begin_ms + ms);
  }
  for (std::uint32_t ms = 0; ms <= 80; ms += 10) {
    const auto state = live.truth->state_at(live.flight_ns(begin_ms + ms));
    ASSERT_TRUE(state.ok() && *state);
    const Eigen::Vector3d expected = frame_at_start().world_from_geodetic(
        geodetic_from_deg(1e-7 * MadeVehicle::lat_at(begin_ms + ms), kLon0, 600.0));
    EXPECT_LT(((*state)->T_world_body.translation - expected).norm(), 0.02) << ms;
    EXPECT_NEAR(attitude_from((*state)->T_world_body.rotation).yaw_rad,
                MadeVehicle::yaw_at(begin_ms + ms),
                1e-5);
  }
}

TEST(LiveTruth, EndsWhenTheVehicleRestarts) {
  OpenedTruth live;
  ASSERT_NE(live.truth, nullptr);
  live.fly_until(live.last_ms + 200);
  for (std::uint32_t ms = 100; ms < 300; ms += 20) live.made->state(ms);
  const auto known = live.truth->state_at(live.flight_ns(live.last_ms));
  ASSERT_TRUE(known.ok() && *known);
  const auto after = live.truth->state_at(live.flight_ns(live.last_ms) + 1);
  ASSERT_TRUE(after.ok()) << after.error().message;
  EXPECT_FALSE(after->has_value());
  ASSERT_EQ(live.truth->warnings().size(), 1U);
  EXPECT_THAT(live.truth->warnings()[0], HasSubstr("the vehicle was restarted"));
}

TEST(LiveTruth, EndsByItsStopConditions) {
  LiveTruthOptions options;
  options.stop.on_disarm = true;
  OpenedTruth disarmed(options);
  ASSERT_NE(disarmed.truth, nullptr);
  disarmed.made->heartbeat(false);  // never armed while it was listened to
  disarmed.fly_until(disarmed.last_ms + 100);
  disarmed.made->heartbeat(true);
  disarmed.fly_until(disarmed.last_ms + 100);
  disarmed.made->heartbeat(false);
  const auto after = disarmed.truth->state_at(disarmed.flight_ns(disarmed.last_ms) + 1);
  ASSERT_TRUE(after.ok());
  EXPECT_FALSE(after->has_value());
  EXPECT_THAT(disarmed.truth->warnings().back(), HasSubstr("the vehicle was disarmed"));

  options = {};
  options.stop.mission_item = 7;
  OpenedTruth mission(options);
  ASSERT_NE(mission.truth, nullptr);
  mission.made->send(frame_bytes(42, PayloadWriter(18).put(0, std::uint16_t{7}).bytes(), 0));
  EXPECT_FALSE(mission.truth->state_at(mission.flight_ns(mission.last_ms) + 1)->has_value());
  EXPECT_THAT(mission.truth->warnings().back(), HasSubstr("the mission has come to item 7"));
}

TEST(LiveTruth, BeginsWithAnItemOfTheMission) {
  const auto vehicle = listening_vehicle("udp-listen:127.0.0.1:0");
  MadeVehicle made(vehicle->address().port);
  made.heartbeat();
  LiveTruthOptions options;
  options.simulation_wait_ns = kNsPerS / 10;
  options.start.mission_item = 5;
  options.stop.mission_item = 9;
  /// The mission comes to the items of a list, one every 2 s of the vehicle's clock, from 12 s on.
  const auto open = [&](std::vector<std::uint16_t> items) {
    std::atomic<bool> opened{false};
    std::thread flying([&] {
      for (std::uint32_t ms = 10000; !opened && ms < 60000; ms += 20) {
        made.state(ms);
        const std::size_t item = ms / 2000 - 6;
        if (ms >= 12000 && ms % 2000 == 0 && item < items.size()) {
          made.send(frame_bytes(42, PayloadWriter(18).put(0, items[item]).bytes(), 0));
        }
        std::this_thread::sleep_for(milliseconds(1));
      }
    });
    auto truth = LiveTruth::open(vehicle, frame_at_start(), options, nullptr);
    opened = true;
    flying.join();
    return truth;
  };
  for (const std::vector<std::uint16_t>& items :
       {std::vector<std::uint16_t>{1, 4, 5}, std::vector<std::uint16_t>{1, 4, 6}}) {
    const auto truth = open(items);
    ASSERT_TRUE(truth.ok()) << truth.error().message;
    EXPECT_EQ((*truth)->start_ns(), 16 * kNsPerS);
    const auto first = (*truth)->state_at(0);
    ASSERT_TRUE(first.ok() && *first);
    const Eigen::Vector3d expected = frame_at_start().world_from_geodetic(
        geodetic_from_deg(1e-7 * MadeVehicle::lat_at(16000), kLon0, 600.0));
    EXPECT_LT(((*first)->T_world_body.translation - expected).norm(), 0.02);
  }
  const auto never = open({1, 9});
  ASSERT_FALSE(never.ok());
  EXPECT_THAT(
      never.error().message,
      HasSubstr("the flight ended before the mission came to item 5: the mission has come to "
                "item 9"));
}

TEST(LiveTruth, SaysWhatIsMissing) {
  LiveTruthOptions options;
  options.patience = milliseconds(100);
  OpenedTruth live(options);
  ASSERT_NE(live.truth, nullptr);
  const auto late = live.truth->state_at(live.flight_ns(live.last_ms) + kNsPerS);
  ASSERT_FALSE(late.ok());
  EXPECT_EQ(late.error().code, ErrorCode::kIo);
  EXPECT_THAT(late.error().message,
              HasSubstr("no new state within 0.1 s: the last message of vehicle 1.1"));
  const std::atomic<bool> cancel{true};
  EXPECT_EQ(live.truth->state_at(live.flight_ns(live.last_ms) + kNsPerS, &cancel).error().code,
            ErrorCode::kCancelled);

  const auto vehicle = listening_vehicle("udp-listen:127.0.0.1:0");
  auto silent = LiveTruth::open(vehicle, frame_at_start(), options, nullptr);
  ASSERT_FALSE(silent.ok());
  EXPECT_THAT(silent.error().message, HasSubstr("no message of the vehicle came within 0.1 s"));
  MadeVehicle made(vehicle->address().port);
  made.heartbeat();
  ASSERT_TRUE(vehicle->wait_until_heard(milliseconds(5000), nullptr).ok());
  options.truth = TruthPreference::kSimulation;
  auto real = LiveTruth::open(vehicle, frame_at_start(), options, nullptr);
  ASSERT_FALSE(real.ok());
  EXPECT_THAT(real.error().message, HasSubstr("the vehicle sends no SIM_STATE"));
}

/// What a recording gives as truth, by the same vehicle's clock.
logs::LogTrajectory recorded(const std::filesystem::path& file, const std::string& source) {
  const Result<logs::OpenedLog> log = logs::open_log(file);
  EXPECT_TRUE(log.ok());
  const auto trajectory = logs::read_log_trajectory(*log, {source, {}, {}});
  EXPECT_TRUE(trajectory.ok());
  return *trajectory;
}

struct Differences {
  std::size_t compared = 0;
  double position_m = 0.0;
  double attitude_deg = 0.0;
};

/// Compares a live flight with the poses of the recording at their times.
Differences differences(LiveTruth& truth, const logs::LogTrajectory& log, std::int64_t until_ns) {
  const LocalFrame frame = frame_at_start();
  Differences found;
  for (const logs::LogPose& pose : log.poses) {
    const std::int64_t t_ns = pose.t_ns - truth.start_ns();
    if (t_ns < 0) continue;
    if (pose.t_ns > until_ns) break;
    const auto state = truth.state_at(t_ns);
    EXPECT_TRUE(state.ok()) << (state.ok() ? "" : state.error().message);
    if (!state.ok() || !*state) break;
    const Geodetic point =
        geodetic_from_deg(pose.position.x(), pose.position.y(), pose.position.z());
    const Eigen::Quaterniond R_world_body =
        frame.R_world_enu_at(point) * logs::R_enu_ned() * pose.R_ned_body;
    ++found.compared;
    found.position_m =
        std::max(found.position_m,
                 ((*state)->T_world_body.translation - frame.world_from_geodetic(point)).norm());
    found.attitude_deg =
        std::max(found.attitude_deg,
                 deg_from_rad(rotation_angle_rad((*state)->T_world_body.rotation, R_world_body)));
  }
  return found;
}

/// Sends the recording by TCP, which loses nothing, with garbage and another system's messages
/// between the frames.
Differences replay_by_tcp(const std::filesystem::path& file,
                          TruthPreference preference,
                          const std::string& source,
                          std::size_t frames) {
  const auto vehicle = listening_vehicle("tcp-listen:127.0.0.1:0");
  std::thread sender([&] {
    PeerSocket socket(SOCK_STREAM);
    if (!socket.connect_to(vehicle->address().port)) return;
    std::size_t sent = 0;
    testing::for_each_frame(file, [&](const mavlink::Frame&, std::span<const std::uint8_t> bytes) {
      Bytes out(bytes.begin(), bytes.end());
      if (sent % 100 == 50) append(out, {0xFD, 0x00, 0xFF, 0x13, 0xFE, 0x09});
      if (sent % 30 == 10)
        append(out, frame_bytes(30, testing::attitude_payload(5, 3, 3, 3), 0, 77));
      return socket.send(out) && ++sent < frames;
    });
  });
  LiveTruthOptions options;
  options.truth = preference;
  auto truth = LiveTruth::open(vehicle, frame_at_start(), options, nullptr);
  Differences found;
  EXPECT_TRUE(truth.ok()) << truth.error().message;
  if (truth.ok()) found = differences(**truth, recorded(file, source), 200 * kNsPerS);
  sender.join();
  const mavlink::VehicleState state = vehicle->state();
  std::printf(
      "%s: %zu poses compared, largest difference %.6f m, %.6f deg, %llu messages, %llu lost\n",
      source.c_str(),
      found.compared,
      found.position_m,
      found.attitude_deg,
      static_cast<unsigned long long>(state.messages),
      static_cast<unsigned long long>(state.lost_messages));
  return found;
}

TEST(LiveTruth, EqualsTheRecordingOfTheSameMessages) {
  OVERFLY_DATA_OR_SKIP(file, "sitl/plane25.tlog");
  const Differences truth = replay_by_tcp(file, TruthPreference::kSimulation, "SIM_STATE", 110'000);
  EXPECT_GT(truth.compared, 3000U);
  EXPECT_LT(truth.position_m, 1e-6);
  EXPECT_LT(truth.attitude_deg, 1e-4);  // recordings keep attitudes as floats
  const Differences estimate =
      replay_by_tcp(file, TruthPreference::kEstimate, "GLOBAL_POSITION_INT", 110'000);
  EXPECT_GT(estimate.compared, 100U);
  EXPECT_LT(estimate.position_m, 1e-6);
  EXPECT_LT(estimate.attitude_deg, 1e-4);
}

}  // namespace
}  // namespace overfly::flight::live
