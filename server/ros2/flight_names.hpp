// Topics and frames of ROS messages about a flight.
#pragma once

#include <string>
#include <vector>

#include "core/motion/pose.hpp"

namespace overfly::server {

/// Names as parts of topics and frames: letters, digits and '_'; all different.
[[nodiscard]] std::vector<std::string> topic_parts(const std::vector<std::string>& names);
/// The first camera is "camera", as nodes expect it; the others are called by their names.
[[nodiscard]] std::vector<std::string> camera_topic_parts(const std::vector<std::string>& names);
/// Frame of a camera. @param part  of its topics
[[nodiscard]] std::string optical_frame(const std::string& part);

/// Attitude of ROS's body axes (base_link: forward, left, up) in the body's (forward, right, down).
[[nodiscard]] Eigen::Quaterniond R_body_base();

/// A constant transform for /tf.
struct RosMount {
  const char* child_frame = nullptr;
  std::string parent_frame;
  Pose T_parent_child;
};
/// Where the body (base_link) is as seen from the first camera, whose pose is on /tf, and where the
/// range sensor of the samples is (range_link). They connect the frames of middleware's
/// frame_names.hpp to one tree. The mount is the nominal one, without vibration.
/// @param with_sensors  false: only the body
[[nodiscard]] std::vector<RosMount> ros_mounts(const Pose& T_body_camera,
                                               const std::string& camera_frame,
                                               bool with_sensors);

}  // namespace overfly::server
