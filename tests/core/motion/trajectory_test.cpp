#include "core/motion/trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace overfly {
namespace {

StampedPose stamped(std::int64_t t_ns, double x_m, double yaw_rad) {
  StampedPose result;
  result.t_ns = t_ns;
  result.pose.translation = {x_m, 0, 0};
  result.pose.rotation = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ());
  return result;
}

TEST(Trajectory, InterpolatesPositionLinearlyAndRotationByArc) {
  const Trajectory trajectory =
      Trajectory::from_poses({stamped(0, 0, 0), stamped(100, 10, 1.0)}).value();
  const Pose pose = trajectory.at(25).value();
  EXPECT_NEAR(pose.translation.x(), 2.5, 1e-12);
  EXPECT_NEAR(rotation_angle_rad(Eigen::Quaterniond::Identity(), pose.rotation), 0.25, 1e-12);
}

TEST(Trajectory, KnowsNoPoseInAGap) {
  Trajectory trajectory;
  trajectory.append_gap();  // before the first pose there is none anyway
  for (const auto& pose : {stamped(0, 0, 0), stamped(100, 10, 0)}) {
    ASSERT_TRUE(trajectory.append(pose).ok());
  }
  trajectory.append_gap();
  ASSERT_TRUE(trajectory.append(stamped(200, 50, 0)).ok());
  ASSERT_TRUE(trajectory.append(stamped(300, 60, 0)).ok());
  EXPECT_TRUE(trajectory.at(50));
  EXPECT_TRUE(trajectory.at(100));
  EXPECT_FALSE(trajectory.at(101));
  EXPECT_FALSE(trajectory.at(199));
  EXPECT_TRUE(trajectory.at(200));
  EXPECT_TRUE(trajectory.at(250));
  EXPECT_EQ(trajectory.path_length_m(), 20.0);
}

TEST(Trajectory, MarksAGapLater) {
  Trajectory trajectory =
      Trajectory::from_poses({stamped(0, 0, 0), stamped(100, 10, 0), stamped(200, 30, 0)}).value();
  trajectory.mark_gap_before(2);
  EXPECT_FALSE(trajectory.has_gap_before(1));
  EXPECT_TRUE(trajectory.has_gap_before(2));
  EXPECT_TRUE(trajectory.at(50));
  EXPECT_FALSE(trajectory.at(150));
  EXPECT_TRUE(trajectory.at(200));
  EXPECT_EQ(trajectory.path_length_m(), 10.0);
}

TEST(Trajectory, GivesTheStoredPoseAtItsStamp) {
  const Trajectory trajectory =
      Trajectory::from_poses({stamped(0, 1, 0), stamped(7, 2, 0.1), stamped(9, 5, 0.2)}).value();
  EXPECT_EQ(trajectory.at(7)->translation.x(), 2.0);
  EXPECT_EQ(trajectory.at(9)->translation.x(), 5.0);
}

TEST(Trajectory, TakesTheShorterArcWhateverTheQuaternionsSign) {
  StampedPose second = stamped(100, 0, 0.2);
  second.pose.rotation.coeffs() *= -1.0;
  const Trajectory trajectory = Trajectory::from_poses({stamped(0, 0, 0), second}).value();
  EXPECT_NEAR(
      rotation_angle_rad(Eigen::Quaterniond::Identity(), trajectory.at(50)->rotation), 0.1, 1e-12);
}

TEST(Trajectory, HasNothingOutsideItsTimes) {
  const Trajectory trajectory =
      Trajectory::from_poses({stamped(10, 0, 0), stamped(20, 1, 0)}).value();
  EXPECT_FALSE(trajectory.at(9).has_value());
  EXPECT_FALSE(trajectory.at(21).has_value());
  EXPECT_FALSE(Trajectory().at(0).has_value());
}

TEST(Trajectory, RefusesTimesThatDoNotIncreaseNamingTheIndex) {
  const auto result =
      Trajectory::from_poses({stamped(0, 0, 0), stamped(5, 0, 0), stamped(5, 0, 0)});
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().message.find("pose 2"), std::string::npos);
}

TEST(Trajectory, RefusesNumbersThatAreNotFinite) {
  EXPECT_FALSE(
      Trajectory::from_poses({stamped(0, std::numeric_limits<double>::infinity(), 0)}).ok());
  StampedPose empty = stamped(0, 0, 0);
  empty.pose.rotation.coeffs().setZero();
  EXPECT_FALSE(Trajectory::from_poses({empty}).ok());
}

TEST(Trajectory, FindsTheNearestPose) {
  const Trajectory trajectory =
      Trajectory::from_poses({stamped(0, 0, 0), stamped(10, 1, 0), stamped(30, 2, 0)}).value();
  EXPECT_EQ(trajectory.nearest(-5), 0U);
  EXPECT_EQ(trajectory.nearest(4), 0U);
  EXPECT_EQ(trajectory.nearest(6), 1U);
  EXPECT_EQ(trajectory.nearest(21), 2U);
  EXPECT_EQ(trajectory.nearest(99), 2U);
}

TEST(Trajectory, PathLengthSumsTheSteps) {
  const Trajectory trajectory =
      Trajectory::from_poses({stamped(0, 0, 0), stamped(1, 3, 0), stamped(2, 1, 0)}).value();
  EXPECT_DOUBLE_EQ(trajectory.path_length_m(), 5.0);
}

}  // namespace
}  // namespace overfly
