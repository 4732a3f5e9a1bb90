// Flights that are played onto the topics of MAVROS and flown from there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <thread>

#include "flight/playback/play.hpp"
#include "flight/playback/topics/topic_outputs.hpp"
#include "flight/ros/ros_truth.hpp"
#include "tests/flight/playback/circle_flight.hpp"
#include "tests/vo_bridges/ros1/ros_world.hpp"

namespace overfly::flight::ros_live {
namespace {

using overfly::testing::RosMaster;
using playback::PlaybackCommand;
using testing::CircleFlight;
using testing::frame_of_circles;
using ::testing::HasSubstr;

constexpr std::int64_t kStepNs = 20'000'000;

/// A playback of circles on a thread of its own, which waits for its listener.
class Player {
 public:
  /// @param commands  at steps of the loop, once somebody listens: of a record's 2 ms or more,
  /// since a clock that jumps is believed after three of them
  explicit Player(double length_s, std::map<int, PlaybackCommand> commands = {})
      : thread_([this, length_s, commands = std::move(commands)] { play(length_s, commands); }) {}
  ~Player() {
    stop_ = true;
    thread_.join();
  }

 private:
  void play(double length_s, const std::map<int, PlaybackCommand>& commands) {
    auto moments = playback::FlightMoments::create({std::make_unique<CircleFlight>(length_s),
                                                    frame_of_circles(),
                                                    1'700'000'000'000'000'000,
                                                    50.0});
    playback::RosTarget target;
    target.master_uri = RosMaster::instance().uri();
    target.node_name = "overfly_flight_test";
    const auto output = playback::ros_output(std::move(*moments), target);
    playback::PlaybackOptions options;
    options.speed = 10.0;
    playback::PlaybackPorts ports;
    int step = 0;
    std::chrono::steady_clock::time_point next_step;
    ports.now = [] { return std::chrono::steady_clock::now(); };
    ports.commands = [&] {
      std::vector<PlaybackCommand> due;
      const auto now = std::chrono::steady_clock::now();
      if (!output->is_heard() || now < next_step) return due;
      next_step = now + std::chrono::milliseconds(2);
      const auto found = commands.find(step++);
      if (found != commands.end()) due.push_back(found->second);
      return due;
    };
    const auto played = playback::play(*output, options, ports, stop_);
    EXPECT_TRUE(played.ok()) << played.error().message;
  }

  std::atomic<bool> stop_{false};
  std::thread thread_;
};

RosFlight mavros_flight() {
  RosFlight flight;
  flight.master_uri = RosMaster::instance().uri();
  flight.node_name = "overfly_flight_test";
  return flight;
}

void expect_the_circle(const AircraftState& state, std::int64_t t_ns) {
  const AircraftState truth = CircleFlight::at(t_ns);
  // Degrees in double precision are 1.6e-9 m.
  EXPECT_LT((state.T_world_body.translation - truth.T_world_body.translation).norm(), 2e-8) << t_ns;
  EXPECT_LT(rotation_angle_rad(state.T_world_body.rotation, truth.T_world_body.rotation), 1e-7)
      << t_ns;
}

TEST(PlayedOntoRos, IsTheSameFlight) {
  ROS_MASTER_OR_SKIP();
  for (const bool local : {false, true}) {
    const Player player(6.0);
    RosFlight flight = mavros_flight();
    flight.local = local;
    flight.attitude_of_pose = local;
    const auto truth = fly_ros(flight, frame_of_circles(), nullptr);
    ASSERT_TRUE(truth.ok()) << truth.error().message;
    for (std::int64_t t_ns = 0; t_ns <= 6 * kNsPerS; t_ns += kStepNs) {
      const auto state = (*truth)->state_at(t_ns);
      ASSERT_TRUE(state.ok() && *state) << t_ns << (state ? "" : state.error().message);
      expect_the_circle(**state, t_ns);
    }
    const auto after = (*truth)->state_at(7 * kNsPerS);
    ASSERT_TRUE(after.ok()) << after.error().message;
    EXPECT_FALSE(*after);
    ASSERT_EQ((*truth)->warnings().size(), 1U);
    EXPECT_EQ((*truth)->warnings()[0], "the flight ended at 6.000 s: the vehicle was disarmed");
    const std::vector<FlightEvent> events = (*truth)->take_events(7 * kNsPerS);
    ASSERT_FALSE(events.empty());
    EXPECT_EQ(events[0].kind, FlightEventKind::kMode);
    EXPECT_EQ(events[0].text, "AUTO");
  }
}

TEST(PlayedOntoRos, PausesUnseenAndSeeksWithAGap) {
  using Kind = PlaybackCommand::Kind;
  ROS_MASTER_OR_SKIP();
  const Player player(12.0,
                      {{3, {Kind::kPause}},
                       {10, {Kind::kPlay}},
                       {14, {Kind::kSpeed, 20.0}},
                       {20, {Kind::kSeek, 8.0}}});
  const auto truth = fly_ros(mavros_flight(), frame_of_circles(), nullptr);
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  int in_the_gap = 0;
  for (std::int64_t t_ns = 0; t_ns <= 12 * kNsPerS; t_ns += kStepNs) {
    const auto state = (*truth)->state_at(t_ns);
    ASSERT_TRUE(state.ok() && *state) << t_ns;
    const AircraftState there = CircleFlight::at(t_ns);
    // A chord of the circle: what was left out is not known.
    if (((*state)->T_world_body.translation - there.T_world_body.translation).norm() > 2e-8) {
      ++in_the_gap;
    }
  }
  EXPECT_GT(in_the_gap, 25);
  EXPECT_LT(in_the_gap, 400);
  EXPECT_THAT((*truth)->warnings()[0], HasSubstr("1 gaps between samples are longer"));
}

TEST(PlayedOntoRos, SeekingBackEndsTheFlight) {
  using Kind = PlaybackCommand::Kind;
  ROS_MASTER_OR_SKIP();
  const Player player(30.0, {{3, {Kind::kSeek, 10.0}}, {30, {Kind::kSeek, 0.0}}});
  const auto truth = fly_ros(mavros_flight(), frame_of_circles(), nullptr);
  ASSERT_TRUE(truth.ok()) << truth.error().message;
  const auto after = (*truth)->state_at(29 * kNsPerS);
  ASSERT_TRUE(after.ok()) << after.error().message;
  EXPECT_FALSE(*after);
  EXPECT_THAT((*truth)->warnings().back(), HasSubstr("went back"));
}

TEST(PlayedOntoRos, NeedsAMaster) {
  auto moments = playback::FlightMoments::create(
      {std::make_unique<CircleFlight>(1.0), frame_of_circles(), std::nullopt, 50.0});
  playback::RosTarget target;
  target.master_uri = "http://127.0.0.1:1";
  target.patience = std::chrono::milliseconds(200);
  const auto output = playback::ros_output(std::move(*moments), target);
  const Status status = output->open(nullptr);
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().message, HasSubstr("http://127.0.0.1:1"));
}

}  // namespace
}  // namespace overfly::flight::ros_live
