// Depth and pose take one frame onto the next: measured by registering images, never by comparing
// one projection with another.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <vector>

#include "renderer/renderer.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

cv::Mat mat_of(const Image& image) {
  return cv::Mat(
             image.height_px, image.width_px, CV_8UC1, const_cast<std::uint8_t*>(image.data.data()))
      .clone();
}

/// The first frame as the second camera sees it: every pixel of the second goes through its own
/// depth and both poses to its place in the first.
cv::Mat warped(const CameraFrame& first, const Pose& second, const DepthImage& second_depth) {
  const PinholeCamera& camera = first.camera.pinhole();
  const Pose T_first_second = first.T_world_camera.inverse() * second;
  cv::Mat map(camera.height_px, camera.width_px, CV_32FC2);
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const Eigen::Vector3d p = second_depth.at(x, y) * camera.ray({x, y});
      const auto pixel = camera.project(T_first_second * p);
      map.at<cv::Vec2f>(y, x) =
          pixel ? cv::Vec2f(static_cast<float>(pixel->x()), static_cast<float>(pixel->y()))
                : cv::Vec2f(-1e4F, -1e4F);
    }
  }
  cv::Mat result;
  cv::remap(mat_of(first.image), result, map, cv::noArray(), cv::INTER_CUBIC);
  return result;
}

/// Median image motion between two images at good features [px].
double median_motion_px(const cv::Mat& from, const cv::Mat& to, int& features) {
  // Away from the border, where the first frame has not seen the ground.
  cv::Mat mask = cv::Mat::zeros(from.size(), CV_8UC1);
  mask(cv::Rect(80, 80, from.cols - 160, from.rows - 160)) = 255;
  std::vector<cv::Point2f> points, tracked;
  cv::goodFeaturesToTrack(from, points, 1500, 0.01, 12, mask);
  std::vector<std::uint8_t> status;
  cv::calcOpticalFlowPyrLK(from,
                           to,
                           points,
                           tracked,
                           status,
                           cv::noArray(),
                           {21, 21},
                           0,
                           {cv::TermCriteria::EPS + cv::TermCriteria::COUNT, 60, 1e-4});
  std::vector<double> motion_px;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (status[i] != 0) motion_px.push_back(cv::norm(tracked[i] - points[i]));
  }
  features = static_cast<int>(motion_px.size());
  if (motion_px.empty()) return 1e9;
  const auto middle = motion_px.begin() + static_cast<std::ptrdiff_t>(motion_px.size() / 2);
  std::nth_element(motion_px.begin(), middle, motion_px.end());
  return *middle;
}

TEST(DepthAndPose, WarpOneFrameOntoTheNextWithinATenthOfAPixel) {
  if (const auto egl = probe_egl(); !egl.ok()) GTEST_SKIP() << egl.error().message;
  const auto tiles = overfly::testing::natural_ground();
  const auto renderer = create_egl_renderer(tiles);
  ASSERT_TRUE(renderer.ok());
  const PinholeCamera camera =
      PinholeCamera::from_fov(1280, 960, rad_from_deg(84.872), FovAxis::kHorizontal).value();
  // 65 deg/s of roll and 25 m/s at 31 Hz, 300 m above hills.
  const double step_s = 1.0 / 31.0;
  for (const double roll_deg : {-30.0, 0.0, 20.0}) {
    SCOPED_TRACE(roll_deg);
    const auto pose = [&](int frame) -> Pose {
      const RollPitchYaw attitude{rad_from_deg(roll_deg + 65.0 * frame * step_s), 0.04, 0.6};
      const Eigen::Vector3d p(
          25.0 * frame * step_s * std::sin(0.6), 25.0 * frame * step_s * std::cos(0.6), 300.0);
      return {R_world_body_from(attitude) * R_body_camera_nadir(), p};
    };
    const auto first = (*renderer)->render_camera(camera, pose(0), 0, PixelFormat::kGrey8);
    const auto second = (*renderer)->render_camera(camera, pose(1), 1, PixelFormat::kGrey8);
    const auto depth = (*renderer)->render_depth(camera, pose(1));
    ASSERT_TRUE(first.ok() && second.ok() && depth.ok());
    const cv::Mat predicted = warped(*first, pose(1), *depth);
    const cv::Mat real = mat_of(second->image);
    int features = 0;
    const double residual_px = median_motion_px(predicted, real, features);
    std::printf("[ WARP     ] roll %.0f deg: median residual %.4f px over %d features\n",
                roll_deg,
                residual_px,
                features);
    EXPECT_GT(features, 300);
    EXPECT_LT(residual_px, 0.1);

    // The measurement sees what it must: a shift of 0.3 px, put in on purpose.
    cv::Mat shifted;
    const cv::Matx23d shift(1, 0, 0.3, 0, 1, 0);
    cv::warpAffine(predicted, shifted, shift, predicted.size(), cv::INTER_CUBIC);
    EXPECT_NEAR(median_motion_px(shifted, real, features), 0.3, 0.06);
  }
}

}  // namespace
}  // namespace overfly::renderer
