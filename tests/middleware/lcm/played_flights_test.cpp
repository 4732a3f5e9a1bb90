// Flights that are played onto LCM channels, received and decoded by LCM's own library.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <overfly_lcm/gps_t.hpp>
#include <overfly_lcm/imu_t.hpp>
#include <overfly_lcm/truth_t.hpp>
#include <thread>
#include <vector>

#include "core/motion/pose.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "flight/playback/play.hpp"
#include "flight/playback/topics/topic_outputs.hpp"
#include "middleware/lcm/network.hpp"
#include "middleware/lcm/node.hpp"
#include "tests/flight/playback/circle_flight.hpp"
#include "tests/support/support.hpp"

namespace overfly::lcm {
namespace {

namespace playback = flight::playback;
using flight::testing::CircleFlight;
using flight::testing::frame_of_circles;
using playback::PlaybackCommand;

/// Plays 10 s of circles at 50 Hz, with a clock that each look at it moves on by 5 ms. `pace` is
/// called with the time of the clock before each look.
playback::PlaybackSummary play_circles(
    const std::string& url,
    const std::map<int, PlaybackCommand>& commands,
    double speed = 20.0,
    const std::function<void(playback::PlaybackClock::TimePoint)>& pace = [](auto) {}) {
  auto moments = playback::FlightMoments::create(
      {std::make_unique<CircleFlight>(10.0), frame_of_circles(), std::nullopt, 50.0});
  EXPECT_TRUE(moments.ok());
  const auto output = playback::lcm_output(std::move(*moments), url);
  EXPECT_EQ(output->count(), 1503U);
  playback::PlaybackOptions options;
  options.speed = speed;
  playback::PlaybackPorts ports;
  playback::PlaybackClock::TimePoint now{};
  int step = 0;
  ports.now = [&] {
    pace(now);
    return now += std::chrono::milliseconds(5);
  };
  ports.commands = [&] {
    std::vector<PlaybackCommand> due;
    const auto found = commands.find(step++);
    if (found != commands.end()) due.push_back(found->second);
    return due;
  };
  const std::atomic<bool> stop{false};
  const auto played = playback::play(*output, options, ports, stop);
  EXPECT_TRUE(played.ok()) << played.error().message;
  return *played;
}

void expect_the_circle(const overfly_lcm::truth_t& message) {
  const AircraftState truth = CircleFlight::at(message.t_ns);
  EXPECT_EQ(message.utime, message.t_ns / 1000);
  EXPECT_EQ(message.stamp_ns, message.t_ns);
  EXPECT_EQ(message.t_ns, message.frame * 20'000'000);
  EXPECT_EQ(Eigen::Vector3d(message.position), truth.T_world_body.translation);
  const Eigen::Quaterniond R_world_camera(message.orientation);
  // The camera looks along the body's z axis, and its x axis is the body's y axis.
  const Eigen::Quaterniond& R = truth.T_world_body.rotation;
  EXPECT_LT((R_world_camera * Eigen::Vector3d::UnitZ() - R * Eigen::Vector3d::UnitZ()).norm(),
            1e-12);
  EXPECT_LT((R_world_camera * Eigen::Vector3d::UnitX() - R * Eigen::Vector3d::UnitY()).norm(),
            1e-12);
}

TEST(PlayedFlights, AreEventLogsOfTheFlight) {
  const overfly::testing::TemporaryFolder folder;
  const auto file = folder.path() / "a.lcm";
  const auto summary = play_circles("file://" + file.string() + "?mode=w", {});
  EXPECT_EQ(summary.sent, 1503U);
  ::lcm::LogFile log(file.string(), "r");
  std::map<std::string, std::int64_t> counts;
  while (const ::lcm::LogEvent* const event = log.readNextEvent()) {
    const auto decode = [&](auto message) {
      EXPECT_GT(message.decode(event->data, 0, event->datalen), 0);
      return message;
    };
    const std::int64_t count = ++counts[event->channel];
    if (event->channel == "OVERFLY_TRUTH") {
      expect_the_circle(decode(overfly_lcm::truth_t()));
    } else if (event->channel == "OVERFLY_GPS") {
      const auto gps = decode(overfly_lcm::gps_t());
      EXPECT_EQ(gps.sequence, count);
      EXPECT_EQ(gps.fix, 3);
      const Geodetic place = frame_of_circles().geodetic_from_world(
          CircleFlight::at(gps.t_ns).T_world_body.translation);
      EXPECT_EQ(gps.lat_deg, deg_from_rad(place.lat_rad));
      EXPECT_EQ(gps.lon_deg, deg_from_rad(place.lon_rad));
      EXPECT_EQ(gps.alt_ellipsoid, place.alt_ellipsoid_m);
    } else {
      const auto imu = decode(overfly_lcm::imu_t());
      EXPECT_EQ(imu.sequence, count);
      EXPECT_EQ(Eigen::Vector3d(imu.angular_rate), CircleFlight::at(imu.t_ns).omega_body_rad_s);
      EXPECT_LT(imu.specific_force[2], -9.0);
    }
  }
  EXPECT_EQ(counts,
            (std::map<std::string, std::int64_t>{
                {"OVERFLY_GPS", 501}, {"OVERFLY_IMU", 501}, {"OVERFLY_TRUTH", 501}}));
  // The program's own reader of event logs finds the body again.
  const auto again = flight::logs::open_log(file);
  ASSERT_TRUE(again.ok()) << again.error().message;
  const auto trajectory = flight::logs::read_log_trajectory(*again, {});
  ASSERT_TRUE(trajectory.ok()) << trajectory.error().message;
  ASSERT_EQ(trajectory->poses.size(), 501U);
  for (const flight::logs::LogPose& pose : trajectory->poses) {
    const AircraftState truth = CircleFlight::at(pose.t_ns);
    EXPECT_LT(rotation_angle_rad(flight::logs::R_enu_ned() * pose.R_ned_body,
                                 truth.T_world_body.rotation),
              1e-7);  // the arc cosine of the angle resolves 1.5e-8
  }
}

TEST(PlayedFlights, ObeyPauseSpeedAndSeek) {
  using Kind = PlaybackCommand::Kind;
  const overfly::testing::TemporaryFolder folder;
  const auto file = folder.path() / "a.lcm";
  (void)play_circles("file://" + file.string() + "?mode=w",
                     {{5, {Kind::kPause}},
                      {9, {Kind::kSpeed, 50.0}},
                      {12, {Kind::kPlay}},
                      {20, {Kind::kSeek, 1.0}},
                      {25, {Kind::kSeek, 9.5}}});
  ::lcm::LogFile log(file.string(), "r");
  std::vector<std::int64_t> frames;
  while (const ::lcm::LogEvent* const event = log.readNextEvent()) {
    if (event->channel != "OVERFLY_TRUTH") continue;
    overfly_lcm::truth_t message;
    ASSERT_GT(message.decode(event->data, 0, event->datalen), 0);
    expect_the_circle(message);
    frames.push_back(message.frame);
  }
  ASSERT_GT(frames.size(), 100U);
  EXPECT_EQ(frames.back(), 500);
  // Without a seek every frame follows the one before; the two seeks go to 1 s and to 9.5 s.
  std::vector<std::int64_t> starts;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (frames[i] != frames[i - 1] + 1) starts.push_back(frames[i]);
  }
  EXPECT_EQ(starts, (std::vector<std::int64_t>{50, 475}));
}

TEST(PlayedFlights, ReachOtherNodesByMulticast) {
  if (const Status status = probe_multicast(kAddress); !status) {
    GTEST_SKIP() << status.error().message;
  }
  const std::string url =
      "udpm://" + std::string(kAddress) + ":" + std::to_string(20000 + getpid() % 20000) + "?ttl=0";
  const auto node = Node::open(with_receive_buffer(*parse_url(url)));
  ASSERT_TRUE(node.ok()) << node.error().message;
  std::atomic<int> received{0};
  const auto take = [&](std::span<const std::uint8_t> bytes) {
    overfly_lcm::truth_t message;
    ASSERT_GT(message.decode(bytes.data(), 0, static_cast<int>(bytes.size())), 0);
    expect_the_circle(message);
    ++received;
  };
  ASSERT_TRUE((*node)->subscribe("OVERFLY_TRUTH", take).ok());
  (*node)->start();
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  const auto wait_for = [&](std::int64_t count) {
    while (received < count && std::chrono::steady_clock::now() < patience) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  };
  // Multicast drops what does not fit into the receiver's buffer: the sender stays at most 20
  // frames ahead of the receiver, however late a busy machine lets that run.
  constexpr double kSpeed = 2.0;
  (void)play_circles(url, {}, kSpeed, [&](playback::PlaybackClock::TimePoint now) {
    const std::chrono::duration<double> played = now.time_since_epoch();
    wait_for(static_cast<std::int64_t>(played.count() * kSpeed * 50.0) - 20);
  });
  wait_for(501);
  (*node)->stop();
  EXPECT_EQ(received, 501);
}

}  // namespace
}  // namespace overfly::lcm
