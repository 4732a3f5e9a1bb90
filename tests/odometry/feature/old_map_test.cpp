// After a long loss: the old map is found again, or the new one gets its scale from the height.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "odometry/feature/feature_odometry.hpp"
#include "tests/odometry/synthetic_flight.hpp"
#include "tests/odometry/test_frame.hpp"

namespace overfly::odometry::feature {
namespace {

using testing::SyntheticFlightOptions;
using testing::SyntheticGround;

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

/// 40 m/s, 200 m above ground; other ground is seen for 5.5 s.
Return fly_away_and_back(const FeatureParameters& parameters) {
  const SyntheticGround here = SyntheticGround::procedural(1, 512, 1.0, 0.0);
  const SyntheticGround there = SyntheticGround::procedural(2, 512, 1.0, 0.0);
  const auto camera =
      PinholeCamera::from_fov(320, 240, rad_from_deg(84.872), FovAxis::kHorizontal).value();
  SyntheticFlightOptions options;
  options.speed_m_s = 40.0;
  options.height_m = 200.0;
  options.straight_s = 60.0;
  options.duration_s = 10.0;
  const std::vector<Pose> line = testing::fly_s_turns(options);
  const auto odometry = create_feature_odometry(parameters).value();
  Return flight;
  for (std::size_t i = 0; i < kFrames; ++i) {
    const bool back = i >= kBackAt;
    const SyntheticGround& seen = i >= kLostAt && !back ? there : here;
    flight.T_world_camera.push_back(line[back ? kBackTo + i - kBackAt : i]);
    const VoFrame frame = testing::test_frame(
        i, camera, seen.render(camera, flight.T_world_camera.back(), 1.0, i + 1));
    flight.samples.push_back(odometry->track(frame).value().sample);
    for (const std::string& text : odometry->take_log()) flight.log.push_back(text);
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
  EXPECT_TRUE(flight.said("scaled by the height"));
}

}  // namespace
}  // namespace overfly::odometry::feature
