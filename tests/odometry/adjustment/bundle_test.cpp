#include "odometry/adjustment/bundle.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "odometry/adjustment/bundle_terms.hpp"
#include "tests/odometry/test_camera.hpp"

namespace overfly::odometry {
namespace {

/// A line of cameras over rough ground, exact; the first two are held.
Bundle exact_bundle() {
  Bundle bundle;
  std::mt19937 rng(11);
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  for (int i = 0; i < 6; ++i) {
    bundle.cameras.push_back(
        {Pose{exp_so3({0.02 * i, -0.01 * i, 0.03 * i}), {0.0, 0.05 * i, 0.0}}, i < 2});
  }
  for (int i = 0; i < 200; ++i) {
    bundle.points_vo.emplace_back(1.2 * uniform(rng), 0.8 * uniform(rng), 1.0 + 0.1 * uniform(rng));
    for (int c = 0; c < 6; ++c) {
      const auto pixel = camera().project(bundle.cameras[static_cast<std::size_t>(c)].T_camera_vo *
                                          bundle.points_vo.back());
      bundle.sights.push_back({c, i, *pixel, 0.2});
    }
  }
  return bundle;
}

Bundle disturbed_bundle(Bundle bundle) {
  std::mt19937 rng(13);
  std::normal_distribution<double> normal(0.0, 1.0);
  const auto noise = [&](double sigma) -> Eigen::Vector3d {
    return sigma * Eigen::Vector3d(normal(rng), normal(rng), normal(rng));
  };
  for (Bundle::Camera& c : bundle.cameras) {
    if (c.fixed) continue;
    Vector6d xi;
    xi << noise(0.005), noise(0.005);
    c.T_camera_vo = moved(c.T_camera_vo, xi);
  }
  for (Eigen::Vector3d& point : bundle.points_vo) point += noise(0.02);
  return bundle;
}

TEST(Bundle, RemovesPlantedNoise) {
  const Bundle truth = exact_bundle();
  Bundle bundle = disturbed_bundle(truth);
  BundleOptions options;
  options.max_iterations = 20;
  EXPECT_LT(adjust(camera(), bundle, options), 1e-2);
  for (std::size_t i = 0; i < bundle.cameras.size(); ++i) {
    const Pose& is = bundle.cameras[i].T_camera_vo;
    const Pose& was = truth.cameras[i].T_camera_vo;
    EXPECT_LT((is.translation - was.translation).norm(), 1e-4) << i;
    EXPECT_LT(rotation_angle_rad(is.rotation, was.rotation), 1e-4) << i;
  }
  for (std::size_t i = 0; i < bundle.points_vo.size(); ++i) {
    EXPECT_LT((bundle.points_vo[i] - truth.points_vo[i]).norm(), 1e-3) << i;
  }
}

TEST(Bundle, LeavesHeldCamerasUntouched) {
  Bundle bundle = disturbed_bundle(exact_bundle());
  const Pose held = bundle.cameras[1].T_camera_vo;
  adjust(camera(), bundle, {});
  EXPECT_EQ(bundle.cameras[1].T_camera_vo.translation, held.translation);
  EXPECT_EQ(bundle.cameras[1].T_camera_vo.rotation.coeffs(), held.rotation.coeffs());
}

TEST(Bundle, GivesWrongSightsLittleWeight) {
  const Bundle truth = exact_bundle();
  Bundle bundle = disturbed_bundle(truth);
  for (std::size_t i = 0; i < bundle.sights.size(); i += 29) bundle.sights[i].pixel.x() += 15.0;
  BundleOptions options;
  options.max_iterations = 20;
  adjust(camera(), bundle, options);
  for (std::size_t i = 0; i < bundle.cameras.size(); ++i) {
    EXPECT_LT((bundle.cameras[i].T_camera_vo.translation - truth.cameras[i].T_camera_vo.translation)
                  .norm(),
              2e-3);
  }
}

TEST(Bundle, SaysWhenAPointIsBehindACamera) {
  Bundle bundle = exact_bundle();
  bundle.points_vo[3].z() = -1.0;
  const Bundle before = bundle;
  EXPECT_EQ(adjust(camera(), bundle, {}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(bundle.points_vo[3], before.points_vo[3]);
  EXPECT_EQ(bundle.cameras[4].T_camera_vo.translation, before.cameras[4].T_camera_vo.translation);
}

TEST(Bundle, RepeatsToTheLastBit) {
  Bundle a = disturbed_bundle(exact_bundle());
  Bundle b = disturbed_bundle(exact_bundle());
  adjust(camera(), a, {});
  adjust(camera(), b, {});
  for (std::size_t i = 0; i < a.points_vo.size(); ++i) EXPECT_EQ(a.points_vo[i], b.points_vo[i]);
}

TEST(Reprojection, JacobiansAgreeWithFiniteDifferences) {
  const PinholeCamera lens{1280, 960, 714.0, 690.0, 639.5, 479.5};
  const Reprojection sight(lens, {500.0, 300.0}, 0.4);
  const PoseManifold manifold;
  PoseBlock pose{};
  store({exp_so3({0.3, -0.2, 0.5}), {0.1, -0.3, 0.4}}, pose.data());
  const Eigen::Vector3d point(0.2, -0.1, 2.0);
  const auto error_at = [&](const PoseBlock& at, const Eigen::Vector3d& p) {
    const double* blocks[] = {at.data(), p.data()};
    Eigen::Vector2d residual;
    EXPECT_TRUE(sight.Evaluate(blocks, residual.data(), nullptr));
    return residual;
  };
  Eigen::Matrix<double, 2, 7, Eigen::RowMajor> J_block;
  Eigen::Matrix<double, 2, 3, Eigen::RowMajor> J_point;
  double* jacobians[] = {J_block.data(), J_point.data()};
  const double* blocks[] = {pose.data(), point.data()};
  Eigen::Vector2d residual;
  ASSERT_TRUE(sight.Evaluate(blocks, residual.data(), jacobians));
  Eigen::Matrix<double, 7, 6, Eigen::RowMajor> J_plus;
  ASSERT_TRUE(manifold.PlusJacobian(pose.data(), J_plus.data()));
  const Eigen::Matrix<double, 2, 6> J_pose = J_block * J_plus;
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const auto moved_by = [&](double step) {
      const Vector6d xi = step * Vector6d::Unit(i);
      PoseBlock there{};
      EXPECT_TRUE(manifold.Plus(pose.data(), xi.data(), there.data()));
      return error_at(there, point);
    };
    const Eigen::Vector2d slope = (moved_by(kStep) - moved_by(-kStep)) / (2.0 * kStep);
    EXPECT_LT((slope - J_pose.col(i)).norm(), 1e-5 * J_pose.norm()) << "pose, " << i;
  }
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
    const Eigen::Vector2d slope =
        (error_at(pose, point + step) - error_at(pose, point - step)) / (2.0 * kStep);
    EXPECT_LT((slope - J_point.col(i)).norm(), 1e-5 * J_point.norm()) << "point, " << i;
  }
}

TEST(PoseManifold, MinusUndoesPlus) {
  const PoseManifold manifold;
  PoseBlock from{};
  PoseBlock to{};
  store({exp_so3({0.3, -0.2, 0.5}), {0.1, -0.3, 0.4}}, from.data());
  Vector6d xi;
  xi << 0.2, -0.1, 0.3, 0.05, 0.4, -0.2;
  ASSERT_TRUE(manifold.Plus(from.data(), xi.data(), to.data()));
  Vector6d back;
  ASSERT_TRUE(manifold.Minus(to.data(), from.data(), back.data()));
  EXPECT_LT((back - xi).norm(), 1e-12);
}

}  // namespace
}  // namespace overfly::odometry
