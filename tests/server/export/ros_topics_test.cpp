// Frames of the exports with ROS messages.
#include "server/export/ros_topics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace overfly::server {
namespace {

/// The pose of a mount's frame in the world.
Pose in_world(const Pose& T_world_parent, const RosMount& mount) {
  return T_world_parent * mount.T_parent_child;
}

TEST(RosMounts, LeadFromTheCameraToTheBodyAndItsRangeSensor) {
  CameraSpec camera;
  camera.T_body_camera.translation = {0.4, -0.1, 0.2};
  // Level, nose to the north: forward is north, down is down.
  Pose T_world_body{Eigen::Quaterniond(0.0, std::sqrt(0.5), std::sqrt(0.5), 0.0),
                    Eigen::Vector3d(10.0, 20.0, 300.0)};
  ASSERT_LT((T_world_body.rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(),
            1e-12);
  const Pose T_world_camera = T_world_body * camera.T_body_camera;
  const std::vector<RosMount> mounts =
      ros_mounts(camera.T_body_camera, "camera_optical_frame", true);
  ASSERT_EQ(mounts.size(), 2U);
  EXPECT_EQ(mounts[0].parent_frame, "camera_optical_frame");
  EXPECT_STREQ(mounts[0].child_frame, "base_link");
  EXPECT_EQ(mounts[1].parent_frame, "base_link");
  EXPECT_STREQ(mounts[1].child_frame, "range_link");
  const Pose base = in_world(T_world_camera, mounts[0]);
  EXPECT_LT((base.translation - T_world_body.translation).norm(), 1e-9);
  // REP 103: x forward, y left, z up.
  const Eigen::Matrix3d axes = base.rotation.toRotationMatrix();
  EXPECT_LT((axes.col(0) - Eigen::Vector3d::UnitY()).norm(), 1e-12) << "north";
  EXPECT_LT((axes.col(1) + Eigen::Vector3d::UnitX()).norm(), 1e-12) << "west";
  EXPECT_LT((axes.col(2) - Eigen::Vector3d::UnitZ()).norm(), 1e-12) << "up";
  // sensor_msgs/Range: the beam is the x axis.
  const Pose range = in_world(base, mounts[1]);
  EXPECT_LT((range.rotation * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_NEAR(range.rotation.norm(), 1.0, 1e-12);
}

}  // namespace
}  // namespace overfly::server
