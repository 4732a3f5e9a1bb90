#include "core/camera/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/motion/pose.hpp"

namespace overfly {
namespace {

PinholeCamera default_camera() {
  return PinholeCamera::from_fov(1280, 960, rad_from_deg(84.872), FovAxis::kHorizontal).value();
}

TEST(PinholeCamera, PapersFieldOfViewGivesAFocalLengthOf700Pixels) {
  const PinholeCamera camera = default_camera();
  EXPECT_NEAR(camera.fx_px, 700.006, 0.0005);
  EXPECT_DOUBLE_EQ(camera.fx_px, camera.fy_px);
  EXPECT_DOUBLE_EQ(camera.cx_px, 639.5);
  EXPECT_DOUBLE_EQ(camera.cy_px, 479.5);
}

TEST(PinholeCamera, AxisOfTheFieldOfViewMatters) {
  const double fov_rad = rad_from_deg(84.872);
  const auto focal = [&](FovAxis axis) {
    return PinholeCamera::from_fov(1280, 960, fov_rad, axis).value().fx_px;
  };
  EXPECT_NEAR(focal(FovAxis::kDiagonal), 875.0, 0.1);
  EXPECT_NEAR(focal(FovAxis::kVertical), 525.0, 0.1);
}

TEST(PinholeCamera, FieldOfViewSpansFromEdgeToEdge) {
  const PinholeCamera camera = default_camera();
  const Eigen::Vector3d left = camera.ray({-0.5, camera.cy_px});
  const Eigen::Vector3d right = camera.ray({1279.5, camera.cy_px});
  const double angle_rad = std::acos(left.normalized().dot(right.normalized()));
  EXPECT_NEAR(deg_from_rad(angle_rad), 84.872, 1e-9);
}

TEST(PinholeCamera, ProjectInvertsRay) {
  PinholeCamera camera = default_camera();
  camera.fy_px = 650.0;
  camera.cx_px = 600.25;
  for (const Eigen::Vector2d& pixel :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(1279, 959), Eigen::Vector2d(17.25, 800.5)}) {
    const auto again = camera.project(camera.ray(pixel) * 321.0);
    ASSERT_TRUE(again.has_value());
    EXPECT_LT((*again - pixel).norm(), 1e-9);
  }
}

TEST(PinholeCamera, PointsBehindDoNotProject) {
  EXPECT_FALSE(default_camera().project({1.0, 1.0, -5.0}).has_value());
  EXPECT_FALSE(default_camera().project({1.0, 1.0, 0.0}).has_value());
}

TEST(PinholeCamera, RefusesValuesOutsideTheirLimitsByName) {
  EXPECT_NE(PinholeCamera::from_fov(1280, 960, rad_from_deg(190.0), FovAxis::kHorizontal)
                .error()
                .message.find("190"),
            std::string::npos);
  EXPECT_FALSE(PinholeCamera::from_fov(0, 960, 1.0, FovAxis::kHorizontal).ok());
  PinholeCamera camera = default_camera();
  camera.fy_px = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(camera.validate().error().message.find("fy_px"), std::string::npos);
}

}  // namespace
}  // namespace overfly
