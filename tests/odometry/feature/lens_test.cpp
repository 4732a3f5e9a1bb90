// The feature estimator behind a lens.
#include <gtest/gtest.h>

#include "core/time.hpp"
#include "odometry/feature/feature_odometry.hpp"
#include "odometry/feature/orb.hpp"
#include "odometry/image/rectifier.hpp"
#include "tests/odometry/synthetic_flight.hpp"
#include "tests/odometry/test_frame.hpp"
#include "tests/odometry/test_lenses.hpp"

namespace overfly::odometry::feature {
namespace {

using testing::barrel;
using testing::lens;
using testing::mat_of;
using testing::pincushion;
using testing::small_camera;
using testing::SyntheticFlightOptions;
using testing::SyntheticGround;

TEST(Rectifier, FindsNoCornerWhereTheLensShowsNothing) {
  const SyntheticGround ground = SyntheticGround::procedural(3, 512, 1.5, 0.0);
  const Pose pose{R_world_body_from({0.1, 0.0, 0.7}) * R_body_camera_nadir(), {0, 0, 250}};
  const CameraModel camera(small_camera(), pincushion());
  const Rectifier rectifier(camera);
  ASSERT_FALSE(rectifier.seen().empty());
  const auto image =
      rectifier.rectify(std::make_shared<const Image>(ground.render(camera, pose, 0.0, 1)));
  OrbExtractor orb{FeatureParameters{}};
  const std::size_t everywhere = orb.detect(mat_of(*image)).size();
  orb.look_only_at(rectifier.seen());
  const std::vector<Corner> corners = orb.detect(mat_of(*image));
  EXPECT_GT(corners.size(), 200U);
  EXPECT_LT(corners.size(), everywhere);
  for (const Corner& corner : corners) {
    const cv::Rect around(
        static_cast<int>(corner.pixel.x()) - 8, static_cast<int>(corner.pixel.y()) - 8, 17, 17);
    EXPECT_EQ(cv::countNonZero(rectifier.seen()(around)), around.area());
  }
}

TEST(Rectifier, MasksNoLevelTooSmallToBeLookedAt) {
  FeatureParameters parameters;
  parameters.levels = 11;
  parameters.scale_factor = 2.0;  // the last is 480 / 1024 rows high
  OrbExtractor orb(parameters);
  cv::Mat seen(480, 640, CV_8U, cv::Scalar(255));
  seen.colRange(0, 40).setTo(0);
  orb.look_only_at(seen);
  EXPECT_TRUE(orb.detect(cv::Mat(480, 640, CV_8U, cv::Scalar(90))).empty());
}

std::vector<VoEstimate> fly_lens(const SyntheticGround& ground, const CameraModel& camera) {
  SyntheticFlightOptions options;
  options.speed_m_s = 40.0;
  options.height_m = 200.0;
  options.straight_s = 1.0;
  options.duration_s = 1.6;
  const auto odometry = create_feature_odometry({}).value();
  const std::vector<Pose> poses = testing::fly_s_turns(options);
  std::vector<VoEstimate> estimates;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    VoFrame frame =
        testing::test_frame(i, camera.pinhole(), ground.render(camera, poses[i], 1.0, i + 1));
    frame.distortion = camera.distortion();
    estimates.push_back(odometry->track(frame).value());
  }
  return estimates;
}

TEST(FeatureOdometry, FliesThroughALensAsThroughAPinhole) {
  const SyntheticGround ground = SyntheticGround::procedural(1, 512, 1.0, 0.0);
  const auto straight = fly_lens(ground, small_camera());
  ASSERT_EQ(straight.back().sample.state, TrackingState::kTracking);
  for (const Distortion& distortion : {barrel(), pincushion()}) {
    const auto bent = fly_lens(ground, CameraModel(small_camera(), distortion));
    const EstimateSample& a = straight.back().sample;
    const EstimateSample& b = bent.back().sample;
    ASSERT_EQ(b.state, TrackingState::kTracking) << distortion.k[0];
    // In units of the first scene depth; 0.1 px of 175 px over it is 0.0006, and noise differs.
    EXPECT_LT(
        (a.T_vo_camera.translation / *a.scene_depth - b.T_vo_camera.translation / *b.scene_depth)
            .norm(),
        0.01)
        << distortion.k[0];
    EXPECT_LT(deg_from_rad(rotation_angle_rad(a.T_vo_camera.rotation, b.T_vo_camera.rotation)), 0.3)
        << distortion.k[0];
    EXPECT_LT(bent.back().counters.at("residual_px"), 1.0);
  }
}

TEST(FeatureOdometry, RefusesALensThatChangesInFlight) {
  const auto odometry = create_feature_odometry({}).value();
  VoFrame frame;
  frame.image = std::make_shared<const Image>(320, 240, 1);
  frame.intrinsics = small_camera();
  frame.distortion = barrel();
  ASSERT_TRUE(odometry->track(frame).ok());
  frame.index = 1;
  frame.t_ns = 1;
  frame.distortion.k[0] += 0.01;
  const auto changed = odometry->track(frame);
  ASSERT_FALSE(changed.ok());
  EXPECT_NE(changed.error().message.find("distortion"), std::string::npos);

  const auto other = create_feature_odometry({}).value();
  frame.distortion = lens(DistortionModel::kRadtan, {-3.0, 0.0, 0.0, 0.0, 0.0});
  const auto folded = other->track(frame);
  ASSERT_FALSE(folded.ok());
  EXPECT_EQ(folded.error().code, ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace overfly::odometry::feature
