// A flight of known motion as a vehicle's messages: byte by byte, as a recording, and flown live.
#include "flight/playback/flight_records.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <thread>

#include "flight/live/live_truth.hpp"
#include "flight/logs/ned_attitude.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "flight/mavlink/frame_finder.hpp"
#include "flight/mavlink/payload.hpp"
#include "flight/playback/link_output.hpp"
#include "flight/playback/play.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/flight/playback/circle_flight.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::playback {
namespace {

using testing::Bytes;
using testing::CircleFlight;
using testing::frame_of_circles;
using ::testing::HasSubstr;
using testing::kCircleLogStartNs;

constexpr std::int64_t kMsInNs = 1'000'000;
/// Of the first message: at the next whole millisecond of the vehicle's clock.
constexpr std::int64_t kFirstNs = 400'000;
constexpr std::int64_t kFirstMs = 12'346;

FlightRecords circles(double length_s, double rate_hz = 50.0) {
  auto records = FlightRecords::create({std::make_unique<CircleFlight>(length_s),
                                        frame_of_circles(),
                                        1'700'000'000'000'000'000,
                                        rate_hz});
  EXPECT_TRUE(records.ok()) << records.error().message;
  return std::move(*records);
}

struct Played {
  std::int64_t t_us = 0;
  std::uint32_t id = 0;
  Bytes payload;
  [[nodiscard]] mavlink::PayloadReader read() const { return mavlink::PayloadReader(payload); }
};

std::vector<Played> all_of(PlaybackRecords& records) {
  std::vector<Played> played;
  while (true) {
    const auto record = records.next();
    EXPECT_TRUE(record.ok()) << record.error().message;
    if (!record || !*record) return played;
    mavlink::FrameFinder finder;
    const auto found = finder.next((*record)->frame, true);
    EXPECT_TRUE(found.frame);
    if (!found.frame) return played;
    played.push_back({(*record)->t_us,
                      found.frame->message_id,
                      {found.frame->payload.begin(), found.frame->payload.end()}});
  }
}

TEST(FlightRecords, HaveTheFlightInTheResolutionOfTheMessages) {
  FlightRecords records = circles(10.0);
  const std::vector<Played> played = all_of(records);
  EXPECT_EQ(played.size(), records.count());
  EXPECT_EQ(records.duration_us(), 9'980'000);
  const LocalFrame frame = frame_of_circles();
  std::map<std::uint32_t, int> counts;
  for (const Played& message : played) {
    ++counts[message.id];
    const auto read = message.read();
    const AircraftState truth = CircleFlight::at(kFirstNs + message.t_us * 1000);
    const std::int64_t boot_ms = kFirstMs + message.t_us / 1000;
    const Geodetic place = frame.geodetic_from_world(truth.T_world_body.translation);
    switch (message.id) {
      case 0:  // HEARTBEAT: a fixed-wing aircraft, armed, in AUTO
        EXPECT_EQ(read.at<std::uint32_t>(0), 10U);
        EXPECT_EQ(read.at<std::uint8_t>(6) & 0x80, 0x80);
        break;
      case 2:  // SYSTEM_TIME
        EXPECT_EQ(read.at<std::uint64_t>(0),
                  1'700'000'000'000'400U + static_cast<std::uint64_t>(message.t_us));
        EXPECT_EQ(read.at<std::uint32_t>(8), boot_ms);
        break;
      case 30:  // ATTITUDE: 0.4 rad to the right; the horizon turns along the way
        EXPECT_EQ(read.at<std::uint32_t>(0), boot_ms);
        EXPECT_NEAR(read.at<float>(4), 0.4, 1e-4);
        break;
      case 108:  // SIM_STATE
        EXPECT_NEAR(read.at<std::int32_t>(84), 1e7 * deg_from_rad(place.lat_rad), 0.51);
        EXPECT_NEAR(read.at<std::int32_t>(88), 1e7 * deg_from_rad(place.lon_rad), 0.51);
        EXPECT_NEAR(read.at<float>(60), place.alt_ellipsoid_m, 1e-4);
        EXPECT_NEAR(read.at<float>(72), truth.v_body_world_m_s.y(), 1e-3);  // north
        EXPECT_NEAR(read.at<float>(76), truth.v_body_world_m_s.x(), 1e-3);
        EXPECT_NEAR(read.at<float>(80), -2.0, 1e-3);
        EXPECT_TRUE(std::isnan(read.at<float>(28)));
        break;
      case 33:  // GLOBAL_POSITION_INT
        EXPECT_NEAR(read.at<std::int32_t>(12), 1e3 * place.alt_ellipsoid_m, 0.51);
        EXPECT_NEAR(read.at<std::int32_t>(16), 2e-3 * static_cast<double>(message.t_us), 6.0);
        break;
      default:
        break;
    }
  }
  EXPECT_EQ(counts,
            (std::map<std::uint32_t, int>{
                {0, 10}, {2, 10}, {30, 500}, {31, 500}, {33, 500}, {108, 500}}));
}

TEST(FlightRecords, ContinueAnywhere) {
  FlightRecords records = circles(4.0);
  const std::vector<Played> all = all_of(records);
  for (const std::int64_t to_us : {3'000'000, 10'001, 0, 4'000'000, 9'000'000}) {
    ASSERT_TRUE(records.seek(to_us).ok());
    const std::vector<Played> rest = all_of(records);
    const auto first = std::find_if(
        all.begin(), all.end(), [&](const Played& each) { return each.t_us >= to_us; });
    ASSERT_EQ(rest.size(), static_cast<std::size_t>(all.end() - first)) << to_us;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      EXPECT_EQ(rest[i].t_us, first[static_cast<std::ptrdiff_t>(i)].t_us);
      EXPECT_EQ(rest[i].payload, first[static_cast<std::ptrdiff_t>(i)].payload);
    }
  }
}

TEST(FlightRecords, SayWhatCannotBePlayed) {
  const auto refusal = [](double length_s, double rate_hz) {
    const auto records = FlightRecords::create(
        {std::make_unique<CircleFlight>(length_s), frame_of_circles(), std::nullopt, rate_hz});
    return records ? "" : records.error().message;
  };
  EXPECT_EQ(refusal(10.0, 1000.0), "");
  EXPECT_THAT(refusal(10.0, 0.5), HasSubstr("rate = 0.5 Hz: must be in [1, 1000]"));
  EXPECT_THAT(refusal(10.0, std::nan("")), HasSubstr("must be in [1, 1000]"));
  EXPECT_THAT(refusal(50.0 * 86400.0, 1.0), HasSubstr("49 days"));
}

/// Written with times of reception, the frames are a telemetry log of the same flight.
TEST(FlightRecords, AreARecordingOfTheFlight) {
  const overfly::testing::TemporaryFolder folder;
  FlightRecords records = circles(20.0, 20.0);
  Bytes bytes;
  while (true) {
    const auto record = records.next();
    ASSERT_TRUE(record.ok());
    if (!*record) break;
    testing::put_big(
        bytes, std::uint64_t{1'700'000'000'000'000} + static_cast<std::uint64_t>((*record)->t_us));
    testing::append(bytes, Bytes((*record)->frame.begin(), (*record)->frame.end()));
  }
  testing::write_bytes(folder.path() / "a.tlog", bytes);
  const auto log = logs::open_log(folder.path() / "a.tlog");
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_TRUE(log->warnings.empty());
  const auto again = logs::read_log_trajectory(*log, {});
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(again->position_source, "1.1/SIM_STATE");
  ASSERT_EQ(again->poses.size(), 400U);
  const LocalFrame frame = frame_of_circles();
  for (const logs::LogPose& pose : again->poses) {
    const AircraftState truth = CircleFlight::at(pose.t_ns - kCircleLogStartNs);
    const Geodetic place =
        geodetic_from_deg(pose.position.x(), pose.position.y(), pose.position.z());
    // 1e-7 deg are 11 mm.
    EXPECT_LT((frame.world_from_geodetic(place) - truth.T_world_body.translation).norm(), 8e-3);
    const Eigen::Quaterniond R = frame.R_world_enu_at(place) * logs::R_enu_ned() * pose.R_ned_body;
    EXPECT_LT(rotation_angle_rad(R, truth.T_world_body.rotation), 1e-6);
  }
}

/// A playback onto a live flight, with a clock that each look at it moves on.
class LivePlayback {
 public:
  LivePlayback(double speed, std::map<int, PlaybackCommand> commands, double length_s = 6.0) {
    mavlink::VehicleOptions listening;
    listening.link.read_only = true;
    const auto any_port = mavlink::parse_link_address("tcp-listen:127.0.0.1:0", "link");
    auto opened_vehicle = mavlink::Vehicle::open(*any_port, listening);
    vehicle_ = std::move(*opened_vehicle);
    thread_ = std::thread([this, speed, length_s, commands = std::move(commands)] {
      PlaybackOptions options;
      options.speed = speed;
      PlaybackClock::TimePoint now{};
      int step = 0;
      PlaybackPorts ports;
      // The first messages give the vehicle's name; the others wait until somebody flies them.
      ports.now = [&] { return go_ ? now += std::chrono::milliseconds(5) : now; };
      ports.commands = [&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(go_ ? 1 : 5));
        std::vector<PlaybackCommand> due;
        if (!go_) return due;
        const auto found = commands.find(step++);
        if (found != commands.end()) due.push_back(found->second);
        return due;
      };
      const auto address = mavlink::parse_link_address(
          "tcp:127.0.0.1:" + std::to_string(vehicle_->address().port), "link");
      const auto output = link_output(std::make_unique<FlightRecords>(circles(length_s)), *address);
      const auto summary = play(*output, options, ports, stop_);
      EXPECT_TRUE(summary.ok()) << summary.error().message;
    });
    EXPECT_TRUE(vehicle_->wait_until_heard(std::chrono::seconds(60), nullptr).ok());
    go_ = true;
    live::LiveTruthOptions options;
    options.patience = std::chrono::seconds(2);
    auto opened = live::LiveTruth::open(vehicle_, frame_of_circles(), options, nullptr);
    EXPECT_TRUE(opened.ok()) << opened.error().message;
    if (opened) truth = std::move(*opened);
  }
  ~LivePlayback() {
    stop_ = true;
    thread_.join();
  }

  std::unique_ptr<live::LiveTruth> truth;

 private:
  std::shared_ptr<mavlink::Vehicle> vehicle_;
  std::atomic<bool> go_{false};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

TEST(FlightRecords, AreFlownLiveAtAnySpeed) {
  for (const double speed : {1.0, 5.0}) {
    LivePlayback playback(
        speed, {{20, {PlaybackCommand::Kind::kPause}}, {60, {PlaybackCommand::Kind::kPlay}}});
    ASSERT_NE(playback.truth, nullptr);
    EXPECT_THAT(playback.truth->description(), HasSubstr("the simulator's state (1.1/SIM_STATE)"));
    const std::int64_t start_ns = playback.truth->start_ns() - kCircleLogStartNs;
    int compared = 0;
    for (std::int64_t t_ns = 0; start_ns + t_ns <= 5900 * kMsInNs; t_ns += 20 * kMsInNs) {
      const auto state = playback.truth->state_at(t_ns);
      ASSERT_TRUE(state.ok() && *state) << (state ? "ended" : state.error().message);
      const AircraftState truth = CircleFlight::at(start_ns + t_ns);
      EXPECT_LT(((*state)->T_world_body.translation - truth.T_world_body.translation).norm(), 8e-3);
      EXPECT_LT(rotation_angle_rad((*state)->T_world_body.rotation, truth.T_world_body.rotation),
                1e-6);
      EXPECT_LT(((*state)->v_body_world_m_s - truth.v_body_world_m_s).norm(), 1e-4);
      ++compared;
    }
    EXPECT_GT(compared, 50);
    EXPECT_TRUE(playback.truth->warnings().empty());
  }
}

TEST(FlightRecords, ASeekIsAJumpOfTheVehiclesClock) {
  {
    LivePlayback forward(1.0, {{100, {PlaybackCommand::Kind::kSeek, 4.5}}});
    ASSERT_NE(forward.truth, nullptr);
    const std::int64_t last_ns = kCircleLogStartNs + 5500 * kMsInNs - forward.truth->start_ns();
    for (std::int64_t t_ns = 0; t_ns <= last_ns; t_ns += 20 * kMsInNs) {
      ASSERT_TRUE(forward.truth->state_at(t_ns).ok());
    }
    ASSERT_EQ(forward.truth->warnings().size(), 1U);
    EXPECT_THAT(forward.truth->warnings()[0], HasSubstr("1 gaps between samples are longer"));
  }
  LivePlayback back(5.0, {{60, {PlaybackCommand::Kind::kSeek, 0.1}}});
  ASSERT_NE(back.truth, nullptr);
  bool ended = false;
  for (std::int64_t t_ns = 0; t_ns < 10 * kNsPerS && !ended; t_ns += 20 * kMsInNs) {
    const auto state = back.truth->state_at(t_ns);
    ASSERT_TRUE(state.ok()) << state.error().message;
    ended = !*state;
  }
  EXPECT_TRUE(ended);
  EXPECT_THAT(back.truth->warnings().at(0), HasSubstr("the vehicle's clock started again"));
}

}  // namespace
}  // namespace overfly::flight::playback
