// Lenses taken out of images, compared with images that never had one.
#include "odometry/feature/rectifier.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "core/time.hpp"
#include "odometry/feature/feature_odometry.hpp"
#include "odometry/feature/orb.hpp"
#include "synthetic_flight.hpp"

namespace overfly::odometry {
namespace {

using testing::SyntheticFlightOptions;
using testing::SyntheticGround;

Distortion lens(DistortionModel model, std::array<double, 5> k) { return {model, k}; }

/// A barrel, as cheap wide-angle lenses have.
Distortion barrel() { return lens(DistortionModel::kRadtan, {-0.22, 0.06, 4e-4, -3e-4, 0.0}); }
/// A pincushion: the pinhole's corners lie outside the lens's image.
Distortion pincushion() { return lens(DistortionModel::kRadtan, {0.12, 0.02, 0.0, 0.0, 0.0}); }
Distortion atan_lens() { return lens(DistortionModel::kFov, {0.9, 0.0, 0.0, 0.0, 0.0}); }

PinholeCamera small_camera() {
  return PinholeCamera::from_fov(320, 240, rad_from_deg(84.872), FovAxis::kHorizontal).value();
}

cv::Mat mat_of(const Image& image) {
  auto* data = const_cast<std::uint8_t*>(image.data.data());
  return cv::Mat(image.height_px, image.width_px, CV_8U, data).clone();
}

TEST(Rectifier, ReturnsTheSameImageWithoutALens) {
  const Rectifier rectifier{CameraModel(small_camera())};
  const auto image = std::make_shared<const Image>(320, 240, 1, std::uint8_t{7});
  EXPECT_EQ(rectifier.rectify(image), image);
  EXPECT_TRUE(rectifier.seen().empty());
}

TEST(Rectifier, ShowsWhatAPinholeShows) {
  const SyntheticGround ground = SyntheticGround::procedural(3, 512, 1.5, 0.0);
  const Pose pose{R_world_body_from({0.3, 0.05, 0.7}) * R_body_camera_nadir(), {0, 0, 250}};
  const PinholeCamera camera = small_camera();
  const cv::Mat wanted = mat_of(ground.render(camera, pose, 0.0, 1));
  for (const Distortion& distortion : {barrel(), pincushion(), atan_lens()}) {
    const CameraModel model(camera, distortion);
    ASSERT_TRUE(model.validate().ok());
    const Rectifier rectifier(model);
    const auto through =
        rectifier.rectify(std::make_shared<const Image>(ground.render(model, pose, 0.0, 1)));
    // The rest is interpolation: phase correlation over the middle sees no shift.
    const cv::Rect middle(60, 40, 200, 160);
    cv::Mat a, b;
    mat_of (*through)(middle).convertTo(a, CV_32F);
    wanted(middle).convertTo(b, CV_32F);
    cv::Mat window;
    cv::createHanningWindow(window, middle.size(), CV_32F);
    const cv::Point2d shift = cv::phaseCorrelate(a, b, window);
    EXPECT_LT(std::hypot(shift.x, shift.y), 0.05) << to_string(distortion.model);
    EXPECT_LT(cv::norm(a, b, cv::NORM_L1) / middle.area(), 4.0) << to_string(distortion.model);
  }
}

TEST(Rectifier, AgreesWithOpenCvsUndistortion) {
  const PinholeCamera camera = small_camera();
  const Distortion radtan = barrel();
  const auto noise = std::make_shared<Image>(320, 240, 1);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      noise->at(x, y) = static_cast<std::uint8_t>(120 + 60 * std::sin(x / 5.0) * std::cos(y / 7.0));
    }
  }
  const cv::Matx33d K(camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  cv::Mat wanted;
  cv::undistort(
      mat_of(*noise), wanted, K, cv::Mat(1, 5, CV_64F, const_cast<double*>(radtan.k.data())));
  const auto rectified = Rectifier(CameraModel(camera, radtan)).rectify(noise);
  // Its tables are in 1/32 px: at 12 grey levels a pixel, half a level, rounded.
  EXPECT_LE(cv::norm(mat_of(*rectified), wanted, cv::NORM_INF), 2.0);
}

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
    VoFrame frame;
    frame.index = static_cast<std::int64_t>(i);
    frame.t_ns = frame_time_ns(frame.index, FrameRate{});
    frame.intrinsics = camera.pinhole();
    frame.distortion = camera.distortion();
    frame.image = std::make_shared<const Image>(ground.render(camera, poses[i], 1.0, i + 1));
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
}  // namespace overfly::odometry
