// Messages of ROS 2 as plain CDR, little-endian (OMG DDS-XTypes 1.3, 7.4.1), and the definitions
// of their types (common_interfaces, rcl_interfaces, geometry2).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"
#include "core/motion/pose.hpp"

namespace overfly::server {

struct Ros2Type {
  const char* name;        ///< "sensor_msgs/msg/Image"
  const char* definition;  ///< as ros2msg, with the types in it
};
extern const Ros2Type kRos2Image;
extern const Ros2Type kRos2CameraInfo;
extern const Ros2Type kRos2PoseStamped;
extern const Ros2Type kRos2TfMessage;

struct Ros2Header {
  std::int64_t stamp_ns = 0;  ///< Unix time in [0, 2^31 s)
  std::string frame_id;
};

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
