#include "core/camera/camera_model.hpp"

#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>
#include <random>

namespace overfly {
namespace {

PinholeCamera rounded_default_camera() {
  return *PinholeCamera::from_fov(
      1280, 960, 84.872 * 3.14159265358979 / 180.0, FovAxis::kHorizontal);
}

const Distortion kRadtan{DistortionModel::kRadtan, {-0.12, 0.02, 2e-4, -3e-4, -0.001}};
const Distortion kEquidistant{DistortionModel::kEquidistant, {-0.02, 0.004, -0.003, 0.0008, 0}};
const Distortion kFov{DistortionModel::kFov, {0.92, 0, 0, 0, 0}};

cv::Mat k_of(const PinholeCamera& camera) {
  return (cv::Mat_<double>(3, 3) << camera.fx_px,
          0,
          camera.cx_px,
          0,
          camera.fy_px,
          camera.cy_px,
          0,
          0,
          1);
}

std::vector<cv::Point3d> points_in_front() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> plane(-0.8, 0.8);
  std::uniform_real_distribution<double> depth(1, 500);
  std::vector<cv::Point3d> points;
  for (int i = 0; i < 1000; ++i) {
    const double z = depth(random);
    points.emplace_back(plane(random) * z, plane(random) * z, z);
  }
  return points;
}

TEST(CameraModel, ProjectsRadtanAsOpenCvDoes) {
  const CameraModel camera(rounded_default_camera(), kRadtan);
  const std::vector<cv::Point3d> points = points_in_front();
  std::vector<cv::Point2d> expected;
  cv::projectPoints(points,
                    cv::Vec3d(0, 0, 0),
                    cv::Vec3d(0, 0, 0),
                    k_of(camera.pinhole()),
                    std::vector<double>(kRadtan.k.begin(), kRadtan.k.end()),
                    expected);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto pixel = camera.project({points[i].x, points[i].y, points[i].z});
    ASSERT_TRUE(pixel.has_value());
    EXPECT_NEAR(pixel->x(), expected[i].x, 1e-9);
    EXPECT_NEAR(pixel->y(), expected[i].y, 1e-9);
  }
}

TEST(CameraModel, ProjectsEquidistantAsOpenCvsFisheyeDoes) {
  const CameraModel camera(rounded_default_camera(), kEquidistant);
  const std::vector<cv::Point3d> points = points_in_front();
  std::vector<cv::Point2d> expected;
  cv::fisheye::projectPoints(
      points,
      expected,
      cv::Vec3d(0, 0, 0),
      cv::Vec3d(0, 0, 0),
      k_of(camera.pinhole()),
      std::vector<double>(kEquidistant.k.begin(), kEquidistant.k.begin() + 4));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto pixel = camera.project({points[i].x, points[i].y, points[i].z});
    ASSERT_TRUE(pixel.has_value());
    EXPECT_NEAR(pixel->x(), expected[i].x, 1e-9);
    EXPECT_NEAR(pixel->y(), expected[i].y, 1e-9);
  }
}

TEST(CameraModel, FovModelIsItsClosedForm) {
  const CameraModel camera(rounded_default_camera(), kFov);
  for (const double angle_deg : {0.0, 5.0, 20.0, 40.0, 50.0}) {
    const double r_u = std::tan(angle_deg * 3.14159265358979 / 180.0);
    const double r_d = std::atan(2.0 * r_u * std::tan(0.5 * 0.92)) / 0.92;
    const auto pixel = camera.project({0.0, r_u, 1.0});
    ASSERT_TRUE(pixel.has_value());
    EXPECT_NEAR(pixel->y(), camera.pinhole().fy_px * r_d + camera.pinhole().cy_px, 1e-9);
  }
}

TEST(CameraModel, RayIsTheInverseOfProjectOverTheWholeImage) {
  for (const Distortion& lens : {Distortion{}, kRadtan, kEquidistant, kFov}) {
    const CameraModel camera(rounded_default_camera(), lens);
    ASSERT_TRUE(camera.validate().ok()) << to_string(lens.model);
    for (double y = -0.5; y <= 959.5; y += 48.0) {
      for (double x = -0.5; x <= 1279.5; x += 40.0) {
        const auto ray = camera.ray({x, y});
        ASSERT_TRUE(ray.has_value()) << to_string(lens.model) << " at " << x << ", " << y;
        const auto pixel = camera.project(*ray);
        ASSERT_TRUE(pixel.has_value());
        EXPECT_NEAR((*pixel - Eigen::Vector2d(x, y)).norm(), 0.0, 1e-7);
      }
    }
  }
}

TEST(CameraModel, JacobianAgreesWithNumericDifferences) {
  for (const Distortion& lens : {kRadtan, kEquidistant, kFov}) {
    const CameraModel camera(rounded_default_camera(), lens);
    for (const Eigen::Vector2d& at : {Eigen::Vector2d(0.3, -0.5), Eigen::Vector2d(-0.7, 0.2)}) {
      Eigen::Matrix2d J;
      (void)camera.distort(at, &J);
      for (int axis = 0; axis < 2; ++axis) {
        const Eigen::Vector2d step = 1e-6 * Eigen::Vector2d::Unit(axis);
        const Eigen::Vector2d slope =
            (camera.distort(at + step, nullptr) - camera.distort(at - step, nullptr)) / 2e-6;
        EXPECT_NEAR((slope - J.col(axis)).norm(), 0.0, 1e-8) << to_string(lens.model);
      }
    }
  }
}

TEST(CameraModel, RefusesADistortionThatFoldsTheImage) {
  const CameraModel camera(rounded_default_camera(),
                           {DistortionModel::kRadtan, {-0.6, 0, 0, 0, 0}});
  const Status status = camera.validate();
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("folds"), std::string::npos) << status.error().message;
}

TEST(CameraModel, DoesNotProjectPointsBeyondTheTurn) {
  const CameraModel camera(rounded_default_camera(),
                           {DistortionModel::kRadtan, {-0.3, 0, 0, 0, 0}});
  // d(r - 0.3 r^3) = 0 at r = 1.054: beyond it points would land inside the image again.
  EXPECT_TRUE(camera.project({1.0, 0.0, 1.0}).has_value());
  EXPECT_FALSE(camera.project({1.2, 0.0, 1.0}).has_value());
  EXPECT_FALSE(camera.project({0.0, 0.0, -1.0}).has_value());
}

}  // namespace
}  // namespace overfly
