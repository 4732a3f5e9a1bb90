#include "odometry/geometry/two_view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>

#include "odometry/geometry/lie.hpp"
#include "odometry/geometry/triangulation.hpp"
#include "tests/odometry/test_camera.hpp"

namespace overfly::odometry {
namespace {

struct Pair {
  std::vector<Eigen::Vector2d> first;
  std::vector<Eigen::Vector2d> second;
};

/// Points at 1 / (n . ray) with depth changed by up to `roughness`, seen with 0.1 px of noise.
Pair views_of(const Pose& T_second_first, double roughness) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> normal(0.0, 0.1);
  const Eigen::Vector3d plane(0.05, -0.1, 1.0);
  Pair pair;
  while (pair.first.size() < 300) {
    const Eigen::Vector2d pixel(1280.0 * uniform(rng), 960.0 * uniform(rng));
    const Eigen::Vector3d ray = camera().ray(pixel);
    const double depth = (1.0 + roughness * (uniform(rng) - 0.5)) / plane.dot(ray);
    const auto seen = camera().project(T_second_first * (depth * ray));
    if (!seen) continue;
    pair.first.push_back(pixel);
    pair.second.push_back(*seen + Eigen::Vector2d(normal(rng), normal(rng)));
  }
  return pair;
}

const Pose kMotion{exp_so3({0.01, -0.03, 0.02}), {0.02, -0.10, 0.01}};

void expect_motion(const Pose& T_second_first, double tolerance_rad) {
  const Eigen::Vector3d direction = kMotion.translation.normalized();
  EXPECT_LT(rotation_angle_rad(T_second_first.rotation, kMotion.rotation), tolerance_rad);
  EXPECT_LT(std::acos(std::min(1.0, direction.dot(T_second_first.translation))),
            20.0 * tolerance_rad);
}

/// The motion where there is but one.
std::optional<TwoViewReconstruction> only_motion(const Pair& pair,
                                                 const TwoViewOptions& options = {}) {
  const auto motions = reconstruct_two_view(camera(), pair.first, pair.second, options);
  return motions.size() == 1 ? std::optional(motions.front()) : std::nullopt;
}

TEST(TwoView, TakesTheMotionOverAPlaneFromTheHomography) {
  const Pair pair = views_of(kMotion, 0.0);
  const auto result = only_motion(pair);
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->planar);
  EXPECT_GT(result->good_count, 290);
  expect_motion(result->T_second_first, 1e-3);
}

TEST(TwoView, TakesTheMotionOverReliefFromTheEssentialMatrix) {
  const Pair pair = views_of(kMotion, 1.0);
  const auto result = only_motion(pair);
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->planar);
  expect_motion(result->T_second_first, 3e-3);
}

/// Flight straight ahead over a plane by a camera that is tilted forward.
Pair tilted_views(double tilt_rad, double noise_px) {
  std::mt19937 rng(17);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> normal(0.0, noise_px);
  const Eigen::Vector3d plane(0.0, std::sin(tilt_rad), std::cos(tilt_rad));
  const Eigen::Vector3d ahead(0.0, -std::cos(tilt_rad), std::sin(tilt_rad));
  const Pose T_second_first{Eigen::Quaterniond::Identity(), -0.08 * ahead};
  Pair pair;
  while (pair.first.size() < 600) {
    const Eigen::Vector2d pixel(1280.0 * uniform(rng), 960.0 * uniform(rng));
    const Eigen::Vector3d ray = camera().ray(pixel);
    const double along = plane.dot(ray);
    if (along < 0.05) continue;
    const auto seen = camera().project(T_second_first * (ray / along));
    if (!seen) continue;
    pair.first.push_back(pixel);
    pair.second.push_back(*seen + Eigen::Vector2d(normal(rng), normal(rng)));
  }
  return pair;
}

TEST(TwoView, TellsThePlanesTwoMotionsApartUpTo25DegreesOfTilt) {
  for (const double tilt_deg : {-25.0, -15.0, -5.0, 5.0, 15.0, 25.0}) {
    const double tilt_rad = rad_from_deg(tilt_deg);
    const Pair pair = tilted_views(tilt_rad, 0.1);
    const auto result = only_motion(pair);
    ASSERT_TRUE(result) << tilt_deg;
    const Eigen::Vector3d back(0.0, std::cos(tilt_rad), -std::sin(tilt_rad));
    EXPECT_LT(rotation_angle_rad(result->T_second_first.rotation, Eigen::Quaterniond::Identity()),
              1e-3)
        << tilt_deg;
    EXPECT_GT(back.dot(result->T_second_first.translation), 0.999) << tilt_deg;
  }
}

TEST(TwoView, GivesBothMotionsOfAPlaneThatTwoViewsCannotTellApart) {
  for (const double tilt_deg : {38.0, 45.0, 50.0}) {
    const double tilt_rad = rad_from_deg(tilt_deg);
    const Pair pair = tilted_views(tilt_rad, 0.1);
    const auto motions = reconstruct_two_view(camera(), pair.first, pair.second, {});
    ASSERT_EQ(motions.size(), 2U) << tilt_deg;
    const Eigen::Vector3d back(0.0, std::cos(tilt_rad), -std::sin(tilt_rad));
    int true_ones = 0;
    for (const TwoViewReconstruction& motion : motions) {
      EXPECT_TRUE(motion.planar);
      EXPECT_GT(motion.good_count, 550);
      const bool still =
          rotation_angle_rad(motion.T_second_first.rotation, Eigen::Quaterniond::Identity()) < 1e-3;
      true_ones += still && back.dot(motion.T_second_first.translation) > 0.999 ? 1 : 0;
    }
    EXPECT_EQ(true_ones, 1) << tilt_deg;
  }
}

TEST(TwoView, LeavesThePlaneOutOfAccountWhenToldTo) {
  const Pair pair = views_of(kMotion, 1.0);
  TwoViewOptions options;
  options.consider_plane = false;
  const auto result = only_motion(pair, options);
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->planar);
}

TEST(TwoView, RefusesAPureRotation) {
  const Pair pair = views_of({exp_so3({0.05, -0.08, 0.1}), {0.0, 0.0, 0.0}}, 0.3);
  EXPECT_TRUE(reconstruct_two_view(camera(), pair.first, pair.second, {}).empty());
}

TEST(TwoView, RefusesTooLittleParallax) {
  const Pair pair = views_of({exp_so3({0.0, 0.0, 0.1}), {0.0, 0.005, 0.0}}, 0.0);
  EXPECT_TRUE(reconstruct_two_view(camera(), pair.first, pair.second, {}).empty());
}

TEST(TwoView, SurvivesWrongMatches) {
  Pair pair = views_of(kMotion, 0.0);
  for (std::size_t i = 0; i < 60; ++i) pair.second[i] = pair.first[(7 * i + 13) % 300];
  const auto result = only_motion(pair);
  ASSERT_TRUE(result);
  expect_motion(result->T_second_first, 1e-3);
}

TEST(HomographyMotions, HoldTheTrueOne) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.1, 0.2, 1.0).normalized();
  const Eigen::Matrix3d H =
      kMotion.rotation.toRotationMatrix() + kMotion.translation * normal.transpose() / 0.9;
  const std::vector<Pose> motions = motions_of_homography(-3.0 * H);
  ASSERT_EQ(motions.size(), 4U);
  EXPECT_TRUE(std::any_of(motions.begin(), motions.end(), [](const Pose& motion) {
    return rotation_angle_rad(motion.rotation, kMotion.rotation) < 1e-6 &&
           (motion.translation - kMotion.translation.normalized()).norm() < 1e-6;
  }));
}

TEST(HomographyMotions, AreNoneForARotation) {
  EXPECT_TRUE(motions_of_homography(kMotion.rotation.toRotationMatrix()).empty());
}

TEST(Triangulation, FindsPointsAndTheirParallax) {
  const Pose T_second_first{exp_so3({0.1, -0.2, 0.05}), {0.3, -0.1, 0.05}};
  const Eigen::Vector3d centre = T_second_first.inverse().translation;
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(0.1, 0.2, 1.0), Eigen::Vector3d(-0.5, 0.3, 2.5)}) {
    const Eigen::Vector3d q = T_second_first * p;
    const auto point = triangulate(p / p.z(), q / q.z(), T_second_first);
    ASSERT_TRUE(point);
    EXPECT_LT((point->p_first - p).norm(), 1e-12);
    const double angle = std::acos(p.normalized().dot((p - centre).normalized()));
    EXPECT_NEAR(point->parallax_rad, angle, 1e-9);
  }
}

TEST(Triangulation, HasNoneBehindACameraOrForParallelRays) {
  const Pose T_second_first{Eigen::Quaterniond::Identity(), {-0.2, 0.0, 0.0}};
  const Eigen::Vector3d ray(0.1, 0.0, 1.0);
  EXPECT_FALSE(triangulate(ray, ray, T_second_first));
  EXPECT_FALSE(triangulate(ray, {0.3, 0.0, 1.0}, T_second_first));  // they meet behind
}

TEST(EssentialMotions, HoldTheTrueOne) {
  const Eigen::Matrix3d E = skew(kMotion.translation) * kMotion.rotation.toRotationMatrix();
  const std::vector<Pose> motions = motions_of_essential(E);
  EXPECT_TRUE(std::any_of(motions.begin(), motions.end(), [](const Pose& motion) {
    return rotation_angle_rad(motion.rotation, kMotion.rotation) < 1e-6 &&
           (motion.translation - kMotion.translation.normalized()).norm() < 1e-6;
  }));
}

TEST(Homography, IsFoundAmongWrongMatches) {
  Eigen::Matrix3d H;
  H << 0.98, -0.05, 12.0, 0.04, 1.01, -7.0, 1e-5, -2e-5, 1.0;
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> uniform(0.0, 900.0);
  std::vector<Eigen::Vector2d> first;
  std::vector<Eigen::Vector2d> second;
  for (int i = 0; i < 200; ++i) {
    first.emplace_back(uniform(rng), uniform(rng));
    second.push_back(i % 3 == 0 ? Eigen::Vector2d(uniform(rng), uniform(rng))
                                : transfer(H, first.back()));
  }
  const auto fit = fit_homography(first, second, 2.0, 1);
  ASSERT_TRUE(fit);
  EXPECT_GE(fit->inliers, 133);
  for (const Eigen::Vector2d& p : first) {
    EXPECT_LT((transfer(fit->H_second_first, p) - transfer(H, p)).norm(), 1e-3);
  }
}

TEST(Homography, NeedsEightPairs) {
  const std::vector<Eigen::Vector2d> few(7, Eigen::Vector2d(1.0, 2.0));
  EXPECT_FALSE(fit_homography(few, few, 1.0, 1));
}

}  // namespace
}  // namespace overfly::odometry
