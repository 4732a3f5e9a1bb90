#include "odometry/adjustment/pose_optimiser.hpp"

#include <gtest/gtest.h>

#include <random>

#include "odometry/geometry/lie.hpp"
#include "tests/odometry/test_camera.hpp"

namespace overfly::odometry {
namespace {

struct Scene {
  Pose T_camera_vo{exp_so3({0.3, -0.2, 1.1}), {0.1, -0.05, 0.2}};
  std::vector<PoseObservation> observations;
};

/// Points over the image at depths around 1, seen with Gaussian noise.
Scene scene_of(int count, double noise_px) {
  Scene scene;
  std::mt19937 rng(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> normal(0.0, 1.0);
  const Pose T_vo_camera = scene.T_camera_vo.inverse();
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d pixel(1280.0 * uniform(rng), 960.0 * uniform(rng));
    const double depth = 0.8 + 0.4 * uniform(rng);
    scene.observations.push_back({T_vo_camera * (depth * camera().ray(pixel)),
                                  pixel + noise_px * Eigen::Vector2d(normal(rng), normal(rng)),
                                  0.2});
  }
  return scene;
}

Pose disturbed(const Pose& T_camera_vo) {
  Vector6d xi;
  xi << 0.03, -0.02, 0.02, 0.02, -0.03, 0.02;
  return moved(T_camera_vo, xi);
}

TEST(PoseOptimiser, RecoversThePlantedPoseFromExactPixels) {
  const Scene scene = scene_of(100, 0.0);
  const PoseFit fit = optimise_pose(camera(), disturbed(scene.T_camera_vo), scene.observations);
  EXPECT_EQ(fit.inliers, 100);
  EXPECT_LT((fit.T_camera_vo.translation - scene.T_camera_vo.translation).norm(), 1e-9);
  EXPECT_LT(rotation_angle_rad(fit.T_camera_vo.rotation, scene.T_camera_vo.rotation), 1e-7);
}

TEST(PoseOptimiser, RejectsWrongMatchesAndKeepsTheRest) {
  Scene scene = scene_of(200, 0.1);
  for (std::size_t i = 0; i < 60; ++i) scene.observations[i].pixel += Eigen::Vector2d(40.0, -25.0);
  Vector6d xi;
  xi << 0.003, -0.002, 0.002, 0.002, -0.001, 0.002;
  PoseFitOptions options;
  options.rounds = 5;
  const PoseFit fit =
      optimise_pose(camera(), moved(scene.T_camera_vo, xi), scene.observations, options);
  for (std::size_t i = 0; i < 200; ++i) EXPECT_EQ(fit.inlier[i], i < 60 ? 0 : 1) << i;
  // 140 points with 0.1 px: about 0.1 / sqrt(140) px of direction, 1e-5 rad; ten times that.
  EXPECT_LT(rotation_angle_rad(fit.T_camera_vo.rotation, scene.T_camera_vo.rotation), 2e-4);
  EXPECT_NEAR(fit.rms_px, 0.1 * std::sqrt(2.0), 0.02);
}

TEST(PoseOptimiser, TooFewPointsLeaveThePoseFinite) {
  const Scene scene = scene_of(2, 0.0);
  const PoseFit fit = optimise_pose(camera(), scene.T_camera_vo, scene.observations);
  EXPECT_TRUE(fit.T_camera_vo.translation.allFinite());
  EXPECT_LT(fit.inliers, 4);
}

TEST(PointJacobian, AgreesWithFiniteDifferences) {
  // As the bundle adjustment takes it: of the pixel by the point in vo.
  const PinholeCamera cam = camera();
  const Pose T_camera_vo{exp_so3({0.1, 0.2, -0.3}), {0.1, 0.0, 0.4}};
  const Eigen::Vector3d point(0.2, -0.1, 0.9);
  const Matrix23d J = projection_jacobian(cam.fx_px, cam.fy_px, T_camera_vo * point) *
                      T_camera_vo.rotation.toRotationMatrix();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d::Unit(i);
    const Eigen::Vector2d ahead = *cam.project(T_camera_vo * (point + step));
    const Eigen::Vector2d behind = *cam.project(T_camera_vo * (point - step));
    EXPECT_LT(((ahead - behind) / 2e-6 - J.col(i)).norm(), 1e-4) << "column " << i;
  }
}

TEST(PoseJacobian, AgreesWithFiniteDifferences) {
  const PinholeCamera cam = camera();
  const Pose T_camera_vo{exp_so3({0.1, 0.2, -0.3}), {0.1, 0.0, 0.4}};
  const Eigen::Vector3d point(0.2, -0.1, 0.9);
  const Eigen::Vector3d p = T_camera_vo * point;
  const Matrix26d J = pose_jacobian(projection_jacobian(cam.fx_px, cam.fy_px, p), p);
  for (int i = 0; i < 6; ++i) {
    Vector6d xi = Vector6d::Zero();
    xi(i) = 1e-6;
    const Eigen::Vector2d ahead = *cam.project(moved(T_camera_vo, xi) * point);
    const Eigen::Vector2d behind = *cam.project(moved(T_camera_vo, -xi) * point);
    EXPECT_LT(((ahead - behind) / 2e-6 - J.col(i)).norm(), 1e-4) << "column " << i;
  }
}

}  // namespace
}  // namespace overfly::odometry
