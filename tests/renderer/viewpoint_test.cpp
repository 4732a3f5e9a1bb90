// Viewpoints against the geometry of a globe: direction, distance, uprightness, no jumps.
#include "renderer/viewpoint.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace overfly::renderer {
namespace {

const FlatGround kPlain(0.0);

Eigen::Vector3d image_top(const Pose& pose) { return pose.rotation * -Eigen::Vector3d::UnitY(); }
Eigen::Vector3d line_of_sight(const Pose& pose) { return pose.rotation * Eigen::Vector3d::UnitZ(); }

TEST(Viewpoint, OrbitStandsWhereItsAnglesSay) {
  const Eigen::Vector3d target(30.0, -20.0, 500.0);
  for (const double azimuth_rad : {0.0, 1.0, 2.5, -2.0}) {
    for (const double elevation_rad : {-1.2, 0.0, 0.7, 1.5}) {
      const Pose pose = orbit_viewpoint(target, {azimuth_rad, elevation_rad, 80.0, 2.0}, kPlain);
      const Eigen::Vector3d away = pose.translation - target;
      EXPECT_NEAR(away.norm(), 80.0, 1e-9);
      EXPECT_NEAR(std::remainder(std::atan2(away.x(), away.y()) - azimuth_rad, 2.0 * kPi), 0, 1e-9);
      EXPECT_NEAR(std::asin(away.z() / 80.0), elevation_rad, 1e-9);
      EXPECT_NEAR((line_of_sight(pose) + away / 80.0).norm(), 0.0, 1e-9);
      EXPECT_NEAR((pose.rotation * Eigen::Vector3d::UnitX()).z(), 0.0, 1e-12) << "level";
      EXPECT_GT(image_top(pose).z(), 0.0) << "upright";
    }
  }
}

TEST(Viewpoint, OrbitDoesNotJumpAtTheVertical) {
  const Eigen::Vector3d target(0.0, 0.0, 500.0);
  for (const double azimuth_rad : {0.0, 0.9, -2.4}) {
    for (const double elevation_rad : {0.5 * kPi, -0.5 * kPi}) {
      const Pose at = orbit_viewpoint(target, {azimuth_rad, elevation_rad, 80.0, 2.0}, kPlain);
      const double near_rad = elevation_rad - std::copysign(0.01, elevation_rad);
      const Pose near = orbit_viewpoint(target, {azimuth_rad, near_rad, 80.0, 2.0}, kPlain);
      EXPECT_NEAR(rotation_angle_rad(at.rotation, near.rotation), 0.01, 1e-6)
          << azimuth_rad << ", " << elevation_rad;
    }
  }
}

TEST(Viewpoint, OrbitIsRaisedAboveTheGround) {
  const Pose pose = orbit_viewpoint({0.0, 0.0, 20.0}, {0.4, -1.0, 100.0, 3.0}, kPlain);
  EXPECT_DOUBLE_EQ(pose.translation.z(), 3.0);
  const Eigen::Vector3d to_target = Eigen::Vector3d(0.0, 0.0, 20.0) - pose.translation;
  EXPECT_NEAR((line_of_sight(pose) - to_target.normalized()).norm(), 0.0, 1e-9);
}

TEST(Viewpoint, ChaseFollowsTheNoseAndIgnoresTheBank) {
  for (const double yaw_rad : {0.0, 1.7, -3.0}) {
    for (const double roll_rad : {0.0, 0.9}) {
      const Pose body{R_world_body_from({roll_rad, 0.2, yaw_rad}), {5.0, 6.0, 300.0}};
      const Pose behind = chase_viewpoint(body, {0.0, 0.0, 50.0, 2.0}, kPlain);
      const Eigen::Vector3d nose(std::sin(yaw_rad), std::cos(yaw_rad), 0.0);
      EXPECT_NEAR((behind.translation - (body.translation - 50.0 * nose)).norm(), 0.0, 1e-9);
      const Pose aside = chase_viewpoint(body, {0.5 * kPi, 0.0, 50.0, 2.0}, kPlain);
      const Eigen::Vector3d left(-nose.y(), nose.x(), 0.0);
      EXPECT_NEAR((aside.translation - (body.translation + 50.0 * left)).norm(), 0.0, 1e-9);
    }
  }
}

TEST(Viewpoint, TopLooksStraightDownWithItsDirectionAtTheTop) {
  for (const double up_rad : {0.0, 0.8, -2.0}) {
    const Pose pose = top_viewpoint({1.0, 2.0, 3.0}, up_rad, 40.0);
    EXPECT_NEAR((pose.translation - Eigen::Vector3d(1.0, 2.0, 43.0)).norm(), 0.0, 1e-12);
    EXPECT_NEAR((line_of_sight(pose) + Eigen::Vector3d::UnitZ()).norm(), 0.0, 1e-12);
    const Eigen::Vector3d top(std::sin(up_rad), std::cos(up_rad), 0.0);
    EXPECT_NEAR((image_top(pose) - top).norm(), 0.0, 1e-12);
  }
}

TEST(Viewpoint, OnboardLooksAlongTheNoseAndTiltsWithTheAircraft) {
  const Pose body{R_world_body_from({0.5, 0.1, 1.2}), {5.0, 6.0, 300.0}};
  const Pose ahead = onboard_viewpoint(body, 0.0, 0.0);
  EXPECT_NEAR((line_of_sight(ahead) - body.rotation * Eigen::Vector3d::UnitX()).norm(), 0.0, 1e-9);
  EXPECT_NEAR((image_top(ahead) + body.rotation * Eigen::Vector3d::UnitZ()).norm(), 0.0, 1e-9);
  EXPECT_NEAR((ahead.translation - body.translation).norm(), 1.0, 1e-9);
  const Pose right = onboard_viewpoint(body, 0.5 * kPi, 0.0);
  EXPECT_NEAR((line_of_sight(right) - body.rotation * Eigen::Vector3d::UnitY()).norm(), 0.0, 1e-9);
  const Pose up = onboard_viewpoint(body, 0.0, 0.5 * kPi);
  EXPECT_NEAR((line_of_sight(up) + body.rotation * Eigen::Vector3d::UnitZ()).norm(), 0.0, 1e-9);
}

TEST(Viewpoint, FreeLooksWhereItsAnglesSay) {
  const Eigen::Vector3d eye(3.0, 4.0, 50.0);
  for (const double azimuth_rad : {0.0, 1.0, -2.5}) {
    for (const double elevation_rad : {-1.2, 0.0, 0.9}) {
      const Pose pose = free_viewpoint(eye, azimuth_rad, elevation_rad, 2.0, kPlain);
      const Eigen::Vector3d ahead(std::cos(elevation_rad) * std::sin(azimuth_rad),
                                  std::cos(elevation_rad) * std::cos(azimuth_rad),
                                  std::sin(elevation_rad));
      EXPECT_NEAR((line_of_sight(pose) - ahead).norm(), 0.0, 1e-9);
      EXPECT_EQ(pose.translation, eye);
      EXPECT_GT(image_top(pose).z(), 0.0) << "upright";
    }
  }
  EXPECT_DOUBLE_EQ(free_viewpoint({0, 0, -9}, 0.0, 0.0, 2.0, kPlain).translation.z(), 2.0);
  // Straight down the image's top lies ahead, without a jump.
  for (const double elevation_rad : {-0.5 * kPi, 0.5 * kPi}) {
    const Pose at = free_viewpoint(eye, 0.7, elevation_rad, 2.0, kPlain);
    const Pose near = free_viewpoint(eye, 0.7, 0.99 * elevation_rad, 2.0, kPlain);
    EXPECT_NEAR(rotation_angle_rad(at.rotation, near.rotation), 0.005 * kPi, 1e-6);
  }
}

}  // namespace
}  // namespace overfly::renderer
