// The first map under noise: the error of the distance travelled relative to the depth.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/time.hpp"
#include "odometry/feature/feature_odometry.hpp"
#include "tests/odometry/synthetic_flight.hpp"
#include "tests/odometry/test_frame.hpp"

namespace overfly::odometry::feature {
namespace {

using testing::SyntheticFlightOptions;
using testing::SyntheticGround;

struct Start {
  double at_s = 1e9;
  /// Relative, of the way from the origin over the depth, both of the first pose.
  double scale_error = 1e9;
};

/// 25 m/s, 300 m above ground of gentle relief, straight on, until the first pose.
Start start_of(double noise, std::uint64_t seed) {
  constexpr double kHeightM = 300.0;
  const SyntheticGround ground = SyntheticGround::procedural(1, 512, 1.2, 0.0);
  const auto camera =
      PinholeCamera::from_fov(400, 300, rad_from_deg(84.872), FovAxis::kHorizontal).value();
  SyntheticFlightOptions options;
  options.straight_s = 60.0;
  options.duration_s = 6.0;
  FeatureParameters parameters;
  parameters.features = 1000;
  const auto odometry = create_feature_odometry(parameters).value();
  const std::vector<Pose> poses = testing::fly_s_turns(options);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const VoFrame frame =
        testing::test_frame(i, camera, ground.render(camera, poses[i], noise, seed * 1000 + i + 1));
    const EstimateSample sample = odometry->track(frame).value().sample;
    if (sample.state != TrackingState::kTracking) continue;
    // The first image is the origin: none was given up.
    const double estimate = sample.T_vo_camera.translation.norm() / sample.scene_depth.value();
    const double truth = (poses[i].translation - poses[0].translation).norm() / kHeightM;
    return {static_cast<double>(sample.t_ns) * 1e-9, std::abs(estimate / truth - 1.0)};
  }
  return {};
}

TEST(NoisyStart, WaitsForParallaxInProportionToTheNoise) {
  double squares = 0.0;
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
    const Start start = start_of(25.0, seed);
    EXPECT_LT(start.at_s, 4.5) << seed;
    squares += start.scale_error * start.scale_error;
  }
  // 0.010; 0.032 with the parallax of quiet images.
  EXPECT_LT(std::sqrt(squares / 5.0), 0.018);
}

TEST(NoisyStart, WaitsNoLongerWithoutNoise) {
  const Start start = start_of(1.5, 1);
  EXPECT_LT(start.at_s, 1.3);
  EXPECT_LT(start.scale_error, 0.004);
}

}  // namespace
}  // namespace overfly::odometry::feature
