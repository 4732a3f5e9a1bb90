#include "core/camera/camera_motion.hpp"

#include <gtest/gtest.h>

namespace overfly {
namespace {

Pose rolled(double angle_rad, double x_m) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitX())),
          Eigen::Vector3d(x_m, 0, 0)};
}

TEST(CameraMotion, StandsStillWithOnePose) {
  const CameraMotion motion(rolled(0.3, 7.0));
  EXPECT_TRUE(motion.still());
  EXPECT_EQ(motion.at(-5).translation.x(), 7.0);
  EXPECT_EQ(motion.at(1'000'000'000).translation.x(), 7.0);
}

TEST(CameraMotion, MovesBetweenItsPosesAndStandsStillOutside) {
  const auto motion = CameraMotion::from_poses(
      {{-100, rolled(0.0, 0.0)}, {0, rolled(0.1, 2.0)}, {300, rolled(0.4, 2.0)}});
  ASSERT_TRUE(motion.ok());
  EXPECT_FALSE(motion->still());
  EXPECT_DOUBLE_EQ(motion->at(-50).translation.x(), 1.0);
  EXPECT_NEAR(rotation_angle_rad(motion->at(100).rotation, rolled(0.2, 0).rotation), 0.0, 1e-12);
  EXPECT_EQ(motion->at(-101).translation.x(), 0.0);
  EXPECT_NEAR(rotation_angle_rad(motion->at(999).rotation, rolled(0.4, 0).rotation), 0.0, 1e-12);
}

TEST(CameraMotion, RefusesNoPosesAndStampsThatDoNotGrow) {
  EXPECT_FALSE(CameraMotion::from_poses({}).ok());
  EXPECT_FALSE(CameraMotion::from_poses({{5, {}}, {5, {}}}).ok());
}

}  // namespace
}  // namespace overfly
