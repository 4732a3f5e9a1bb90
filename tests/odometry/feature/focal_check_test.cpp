// A warning is given for a focal length that the images contradict, and for no other.
#include "odometry/feature/map/focal_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/time.hpp"
#include "odometry/feature/feature_odometry.hpp"
#include "tests/odometry/synthetic_flight.hpp"

namespace overfly::odometry::feature {
namespace {

using testing::SyntheticFlightOptions;
using testing::SyntheticGround;

struct Plan {
  double relief_m = 0.0;
  double told_focal = 1.0;  ///< of the focal length the images are made with
  Distortion distortion;
};

/// What the estimator says on a flight of S-turns.
std::vector<std::string> log_of(const Plan& plan) {
  const SyntheticGround ground = SyntheticGround::procedural(1, 1024, 0.8, plan.relief_m);
  const PinholeCamera camera =
      PinholeCamera::from_fov(480, 360, rad_from_deg(84.872), FovAxis::kHorizontal).value();
  SyntheticFlightOptions options;
  options.straight_s = 1.5;
  options.hold_s = 0.3;
  options.duration_s = 9.0;
  FeatureParameters parameters;
  parameters.features = 800;
  const auto odometry = create_feature_odometry(parameters).value();
  std::vector<std::string> log;
  int tracked = 0;
  const std::vector<Pose> poses = testing::fly_s_turns(options);
  // Every second frame: as good, and half the time.
  for (std::size_t i = 0; i < poses.size(); i += 2) {
    VoFrame frame;
    frame.index = static_cast<std::int64_t>(i);
    frame.t_ns = frame_time_ns(frame.index, FrameRate{});
    frame.intrinsics = camera;
    frame.intrinsics.fx_px *= plan.told_focal;
    frame.intrinsics.fy_px *= plan.told_focal;
    frame.distortion = plan.distortion;
    frame.image = std::make_shared<const Image>(
        ground.render(CameraModel(camera, plan.distortion), poses[i], 1.5, i + 1));
    const auto estimate = odometry->track(frame);
    EXPECT_TRUE(estimate);
    if (estimate->sample.state == TrackingState::kTracking) ++tracked;
    for (const std::string& line : odometry->take_log()) log.push_back(line);
  }
  EXPECT_GT(tracked, 100);
  return log;
}

int warnings(const std::vector<std::string>& log) {
  return static_cast<int>(std::count_if(log.begin(), log.end(), [](const std::string& line) {
    return line.find("contradict the calibration") != std::string::npos;
  }));
}

TEST(FocalCheck, WarnsOfAFocalLengthThatIsTenPercentOff) {
  for (const auto& [relief_m, ratio] : {std::pair(0.0, 0.9), std::pair(15.0, 1.1)}) {
    const std::vector<std::string> log = log_of({relief_m, ratio, {}});
    EXPECT_EQ(warnings(log), 1) << relief_m << " m, " << ratio;
  }
}

TEST(FocalCheck, SaysNothingOfAGoodCalibration) {
  for (const double relief_m : {0.0, 15.0})
    EXPECT_EQ(warnings(log_of({relief_m, 1.0, {}})), 0) << relief_m;
}

TEST(FocalCheck, SaysNothingOfAGoodLens) {
  Plan plan;
  plan.relief_m = 15.0;
  plan.distortion.model = DistortionModel::kRadtan;
  plan.distortion.k = {-0.12, 0.02, 0.0, 0.0, 0.0};
  EXPECT_EQ(warnings(log_of(plan)), 0);
}

}  // namespace
}  // namespace overfly::odometry::feature
