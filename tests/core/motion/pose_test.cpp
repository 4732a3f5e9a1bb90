#include "core/motion/pose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace overfly {
namespace {

Pose random_pose(std::mt19937_64& engine) {
  std::normal_distribution<double> normal;
  Pose pose;
  pose.rotation = Eigen::Quaterniond(normal(engine), normal(engine), normal(engine), normal(engine))
                      .normalized();
  pose.translation = Eigen::Vector3d(normal(engine), normal(engine), normal(engine)) * 100.0;
  return pose;
}

TEST(Pose, ProductsAndInversesAgreeWithMatrices) {
  std::mt19937_64 engine(3);
  for (int i = 0; i < 100; ++i) {
    const Pose a = random_pose(engine);
    const Pose b = random_pose(engine);
    EXPECT_LT(((a * b).matrix() - a.matrix() * b.matrix()).norm(), 1e-10);
    EXPECT_LT((a.inverse().matrix() - a.matrix().inverse()).norm(), 1e-10);
  }
}

TEST(Similarity, InverseUndoesIt) {
  std::mt19937_64 engine(4);
  const Pose pose = random_pose(engine);
  const Similarity S_a_b{283.0, pose.rotation, pose.translation};
  const Eigen::Vector3d p_b(0.3, -0.2, 1.1);
  EXPECT_LT((S_a_b.inverse() * (S_a_b * p_b) - p_b).norm(), 1e-12);
}

TEST(Attitude, LevelNorthboundFliesNorthWithRightWingEast) {
  const Eigen::Quaterniond R_world_body = R_world_body_from({0.0, 0.0, 0.0});
  EXPECT_LT((R_world_body * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((R_world_body * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((R_world_body * Eigen::Vector3d::UnitZ() + Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(Attitude, SignsAreThoseOfThePilot) {
  // Right roll lowers the right wing; nose up raises the nose; yaw 90 deg flies east.
  const double angle = rad_from_deg(30.0);
  EXPECT_LT((R_world_body_from({angle, 0, 0}) * Eigen::Vector3d::UnitY()).z(), 0.0);
  EXPECT_GT((R_world_body_from({0, angle, 0}) * Eigen::Vector3d::UnitX()).z(), 0.0);
  EXPECT_NEAR((R_world_body_from({0, 0, kPi / 2}) * Eigen::Vector3d::UnitX()).x(), 1.0, 1e-12);
}

TEST(Attitude, RoundTrips) {
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> turn(-3.1, 3.1);
  std::uniform_real_distribution<double> pitch(-1.5, 1.5);
  for (int i = 0; i < 1000; ++i) {
    const RollPitchYaw in{turn(engine), pitch(engine), turn(engine)};
    const RollPitchYaw out = attitude_from(R_world_body_from(in));
    EXPECT_NEAR(out.roll_rad, in.roll_rad, 1e-9);
    EXPECT_NEAR(out.pitch_rad, in.pitch_rad, 1e-9);
    EXPECT_NEAR(out.yaw_rad, in.yaw_rad, 1e-9);
  }
}

TEST(NadirMount, ImageTopIsTheNoseAndTheCameraLooksDown) {
  const Eigen::Quaterniond R_world_camera = R_world_body_from({0, 0, 0}) * R_body_camera_nadir();
  EXPECT_LT((R_world_camera * Eigen::Vector3d::UnitZ() + Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  // Flying north: image up (-y) is north, image right (+x) is east.
  EXPECT_LT((R_world_camera * -Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((R_world_camera * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitX()).norm(), 1e-12);
}

TEST(RotationAngle, IsExactNearZeroAndNearPi) {
  for (double angle : {1e-9, 1e-4, 1.0, 3.0, kPi - 1e-9}) {
    const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, -1).normalized()));
    EXPECT_NEAR(rotation_angle_rad(Eigen::Quaterniond::Identity(), q), angle, 1e-12);
    const Eigen::Quaterniond same(-q.w(), -q.x(), -q.y(), -q.z());
    EXPECT_NEAR(rotation_angle_rad(q, same), 0.0, 1e-12);
  }
}

TEST(ShortestRotation, TurnsOneDirectionToTheOtherByTheAngleBetweenThem) {
  std::mt19937_64 engine(6);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d from(normal(engine), normal(engine), normal(engine));
    // Every third pair is almost opposite, every other third almost the same.
    const Eigen::Vector3d near_from = from * (i % 3 == 0 ? -2.0 : 3.0) +
                                      1e-9 * Eigen::Vector3d(normal(engine), normal(engine), 1.0);
    const Eigen::Vector3d to =
        i % 3 == 2 ? Eigen::Vector3d(normal(engine), normal(engine), normal(engine)) : near_from;
    const Eigen::Quaterniond R = shortest_rotation(from, to);
    EXPECT_LT((R * from.normalized() - to.normalized()).norm(), 1e-12);
    const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
    EXPECT_NEAR(rotation_angle_rad(Eigen::Quaterniond::Identity(), R), angle, 1e-7);
  }
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  EXPECT_LT((shortest_rotation(x, -x) * x + x).norm(), 1e-12);
}

TEST(WrapPi, KeepsPlusPiAndFoldsTheRest) {
  EXPECT_DOUBLE_EQ(wrap_pi(kPi), kPi);
  EXPECT_DOUBLE_EQ(wrap_pi(-kPi), kPi);
  EXPECT_NEAR(wrap_pi(3.0 * kPi / 2.0), -kPi / 2.0, 1e-12);
  EXPECT_NEAR(wrap_pi(-7.0), -7.0 + 2.0 * kPi, 1e-12);
}

}  // namespace
}  // namespace overfly
