#include "odometry/feature/bundle.hpp"

#include <gtest/gtest.h>

#include <random>

namespace overfly::odometry {
namespace {

PinholeCamera camera() { return {1280, 960, 700.0, 700.0, 639.5, 479.5}; }

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

Bundle disturbed(Bundle bundle) {
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
  Bundle bundle = disturbed(truth);
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
  Bundle bundle = disturbed(exact_bundle());
  const Pose held = bundle.cameras[1].T_camera_vo;
  adjust(camera(), bundle, {});
  EXPECT_EQ(bundle.cameras[1].T_camera_vo.translation, held.translation);
  EXPECT_EQ(bundle.cameras[1].T_camera_vo.rotation.coeffs(), held.rotation.coeffs());
}

TEST(Bundle, GivesWrongSightsLittleWeight) {
  const Bundle truth = exact_bundle();
  Bundle bundle = disturbed(truth);
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

TEST(Bundle, RepeatsToTheLastBit) {
  Bundle a = disturbed(exact_bundle());
  Bundle b = disturbed(exact_bundle());
  adjust(camera(), a, {});
  adjust(camera(), b, {});
  for (std::size_t i = 0; i < a.points_vo.size(); ++i) EXPECT_EQ(a.points_vo[i], b.points_vo[i]);
}

}  // namespace
}  // namespace overfly::odometry
