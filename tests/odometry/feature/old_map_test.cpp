// After a long loss: the old map is found again, or the new one gets its scale from the height.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/time.hpp"
#include "odometry/feature/feature_odometry.hpp"
#include "tests/odometry/synthetic_flight.hpp"
#include "tests/odometry/test_frame.hpp"
#include "tests/odometry/tower_scene.hpp"

namespace overfly::odometry::feature {
namespace {

using testing::SyntheticFlightOptions;
using testing::SyntheticGround;
using testing::TowersBeforeAPlain;

constexpr std::size_t kLostAt = 70;   ///< frame from which other ground is seen
constexpr std::size_t kBackAt = 240;  ///< and from which the first is seen again
constexpr std::size_t kBackTo = 50;   ///< frame whose place it comes back to
constexpr std::size_t kFrames = 285;

struct Return {
  std::vector<EstimateSample> samples;
  std::vector<Pose> T_world_camera;
  std::vector<std::string> log;

  [[nodiscard]] bool said(const std::string& words) const {
    return std::any_of(log.begin(), log.end(), [&](const std::string& line) {
      return line.find(words) != std::string::npos;
    });
  }
};

PinholeCamera camera_of_flight() {
  return PinholeCamera::from_fov(320, 240, rad_from_deg(84.872), FovAxis::kHorizontal).value();
}

/// 200 m above ground.
std::vector<Pose> straight_line(double speed_m_s, double duration_s) {
  SyntheticFlightOptions options;
  options.speed_m_s = speed_m_s;
  options.height_m = 200.0;
  options.straight_s = 60.0;
  options.duration_s = duration_s;
  return testing::fly_s_turns(options);
}

/// Tracks a frame, and adds what comes of it.
void track_image(VoPort& odometry, std::size_t index, Image image, Return& flight) {
  const VoFrame frame = testing::test_frame(index, camera_of_flight(), std::move(image));
  flight.samples.push_back(odometry.track(frame).value().sample);
  for (const std::string& text : odometry.take_log()) flight.log.push_back(text);
}

/// 40 m/s; other ground is seen for 5.5 s.
Return fly_away_and_back(const FeatureParameters& parameters) {
  const SyntheticGround here = SyntheticGround::procedural(1, 512, 1.0, 0.0);
  const SyntheticGround there = SyntheticGround::procedural(2, 512, 1.0, 0.0);
  const std::vector<Pose> line = straight_line(40.0, 10.0);
  const auto odometry = create_feature_odometry(parameters).value();
  Return flight;
  for (std::size_t i = 0; i < kFrames; ++i) {
    const bool back = i >= kBackAt;
    const SyntheticGround& seen = i >= kLostAt && !back ? there : here;
    flight.T_world_camera.push_back(line[back ? kBackTo + i - kBackAt : i]);
    track_image(*odometry,
                i,
                seen.render(camera_of_flight(), flight.T_world_camera.back(), 1.0, i + 1),
                flight);
  }
  return flight;
}

class OldMapOf : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Threads, OldMapOf, ::testing::Values(1, 2));

TEST_P(OldMapOf, GoesOnWhereItsPlaceIsSeenAgain) {
  FeatureParameters parameters;
  parameters.threads = GetParam();
  const Return flight = fly_away_and_back(parameters);
  ASSERT_EQ(flight.samples[kLostAt - 1].state, TrackingState::kTracking);
  EXPECT_EQ(flight.samples[kBackAt - 1].map_id, 1);
  const EstimateSample& last = flight.samples.back();
  ASSERT_EQ(last.state, TrackingState::kTracking);
  EXPECT_EQ(last.map_id, 0);
  EXPECT_TRUE(flight.said("recovered map 0"));
  // In the old map's frame and scale: 15 frames after the loss's place, 40 m/s.
  const EstimateSample& before = flight.samples[kLostAt - 1];
  const double way_m =
      200.0 * (last.T_vo_camera.translation - before.T_vo_camera.translation).norm();
  const double true_way_m =
      (flight.T_world_camera.back().translation - flight.T_world_camera[kLostAt - 1].translation)
          .norm();
  EXPECT_GT(true_way_m, 25.0);
  EXPECT_NEAR(way_m, true_way_m, 1.0);
}

TEST(OldMap, GivesTheNewMapItsHeight) {
  FeatureParameters parameters;
  parameters.initial_height_m = 200.0;
  const Return flight = fly_away_and_back(parameters);
  const EstimateSample& second = flight.samples[kBackAt - 1];
  ASSERT_EQ(second.state, TrackingState::kTracking);
  ASSERT_EQ(second.map_id, 1);
  EXPECT_NEAR(second.scene_depth.value(), 200.0, 3.0);
  EXPECT_TRUE(flight.said("scaled by the last known height"));
}

/// A time without images is no search of the map.
TEST(OldMap, IsNotGivenUpForAGapInTheImages) {
  const SyntheticGround here = SyntheticGround::procedural(1, 512, 1.0, 0.0);
  const SyntheticGround there = SyntheticGround::procedural(2, 512, 1.0, 0.0);
  const std::vector<Pose> line = straight_line(40.0, 10.0);
  const auto odometry = create_feature_odometry({}).value();
  Return flight;
  const auto see = [&](std::size_t index, const SyntheticGround& ground, std::size_t place) {
    track_image(
        *odometry, index, ground.render(camera_of_flight(), line[place], 1.0, index + 1), flight);
    return flight.samples.back();
  };
  for (std::size_t i = 0; i < kLostAt; ++i) see(i, here, i);
  ASSERT_EQ(flight.samples.back().state, TrackingState::kTracking);
  EXPECT_EQ(see(kLostAt, there, kLostAt).state, TrackingState::kLost);
  // 5 s later, one image in which it is not found.
  const std::size_t later = kLostAt + 155;
  EXPECT_EQ(see(later, there, later).state, TrackingState::kLost);
  EXPECT_EQ(see(later + 1, here, kBackTo).state, TrackingState::kTracking);
  EXPECT_EQ(flight.samples.back().map_id, 0);
}

/// The first map begins over towers, where no plane gives its scale. Later it is over level ground,
/// whose distance is not known in metres.
TEST(OldMap, WithoutAScaleGivesNoHeight) {
  const TowersBeforeAPlain here(140.0);
  const SyntheticGround there = SyntheticGround::procedural(2, 512, 1.0, 0.0);
  const PinholeCamera camera = camera_of_flight();
  const std::vector<Pose> line = straight_line(20.0, 34.0);
  FeatureParameters parameters;
  parameters.initial_height_m = 200.0;
  const auto odometry = create_feature_odometry(parameters).value();
  Return flight;
  constexpr std::size_t kSlowTo = 28;
  constexpr std::size_t kOverThePlain = 145;
  constexpr std::size_t kEnd = 260;
  for (std::size_t i = 0; i < kEnd; ++i) {
    const Pose& pose = line[i < kSlowTo ? i : kSlowTo + 4 * (i - kSlowTo)];
    // The first image is of other ground, so that the first map is made by descriptors.
    Image image = i > 0 && i < kOverThePlain ? here.render(camera, pose, 1.0, i + 1)
                                             : there.render(camera, pose, 1.0, i + 1);
    track_image(*odometry, i, std::move(image), flight);
  }
  EXPECT_TRUE(flight.said("no ground plane was found"));
  ASSERT_EQ(flight.samples[kOverThePlain - 1].state, TrackingState::kTracking);
  ASSERT_EQ(flight.samples[kOverThePlain - 1].map_id, 0);
  const EstimateSample& second = flight.samples.back();
  ASSERT_EQ(second.state, TrackingState::kTracking);
  ASSERT_EQ(second.map_id, 1);
  EXPECT_NEAR(second.scene_depth.value(), 200.0, 3.0);
}

}  // namespace
}  // namespace overfly::odometry::feature
