// Lenses taken out of images, compared with images that never had one.
#include "odometry/image/rectifier.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/odometry/synthetic_flight.hpp"
#include "tests/odometry/test_lenses.hpp"

namespace overfly::odometry {
namespace {

using testing::atan_lens;
using testing::barrel;
using testing::mat_of;
using testing::pincushion;
using testing::small_camera;
using testing::SyntheticGround;

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

}  // namespace
}  // namespace overfly::odometry
