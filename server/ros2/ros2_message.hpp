// Messages of ROS 2 about cameras and poses, as plain CDR, little-endian (OMG DDS-XTypes 1.3,
// 7.4.1), and the definitions of their types (common_interfaces, rcl_interfaces, geometry2).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"
#include "core/motion/pose.hpp"
#include "server/ros2/ros2_type.hpp"

namespace overfly::server {

extern const Ros2Type kRos2Image;
extern const Ros2Type kRos2CameraInfo;
extern const Ros2Type kRos2PoseStamped;
extern const Ros2Type kRos2TfMessage;

/// mono8 or rgb8.
[[nodiscard]] std::vector<std::uint8_t> ros2_image(const Ros2Header& header, const Image& image);
/// Lens models as in bags: plumb_bob, equidistant, fov.
[[nodiscard]] std::vector<std::uint8_t> ros2_camera_info(const Ros2Header& header,
                                                         const CameraModel& camera);
[[nodiscard]] std::vector<std::uint8_t> ros2_pose(const Ros2Header& header, const Pose& pose);
/// One transform.
[[nodiscard]] std::vector<std::uint8_t> ros2_transform(const Ros2Header& header,
                                                       const std::string& child_frame,
                                                       const Pose& T_parent_child);

}  // namespace overfly::server
