#include "tests/vo_bridges/vo_port_contract.hpp"
#include "tests/odometry/test_frame.hpp"

#include "odometry/feature/feature_odometry.hpp"
#include "tests/odometry/synthetic_flight.hpp"

namespace overfly::testing {
namespace {

std::unique_ptr<VoPort> create() {
  odometry::feature::FeatureParameters parameters;
  parameters.features = 600;
  return odometry::feature::create_feature_odometry(parameters).value();
}

/// Fast and low, so that the first map comes within the second.
std::vector<VoFrame> frames() {
  const auto ground = odometry::testing::SyntheticGround::procedural(4, 512, 1.2, 0.0);
  const auto camera =
      PinholeCamera::from_fov(320, 240, rad_from_deg(84.872), FovAxis::kHorizontal).value();
  odometry::testing::SyntheticFlightOptions options;
  options.speed_m_s = 40.0;
  options.height_m = 200.0;
  options.duration_s = 1.0;
  const std::vector<Pose> poses = odometry::testing::fly_s_turns(options);
  std::vector<VoFrame> frames;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    frames.push_back(
        odometry::testing::test_frame(i, camera, ground.render(camera, poses[i], 1.0, i + 1)));
  }
  return frames;
}

INSTANTIATE_TEST_SUITE_P(Feature,
                         VoPortContract,
                         ::testing::Values(VoPortCase{"feature", create, frames, 8}));

}  // namespace
}  // namespace overfly::testing
