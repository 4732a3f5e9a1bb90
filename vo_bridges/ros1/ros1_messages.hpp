// Between our values and ROS messages.
#pragma once

#include <ros/time.h>

#include <cstdint>
#include <optional>
#include <string>

#include "core/camera.hpp"
#include "core/camera_model.hpp"
#include "core/image.hpp"
#include "core/pose.hpp"
#include "core/result.hpp"
#include "vo_bridges/ros1/ros1_types.hpp"

namespace overfly::ros1 {

/// @pre t_ns is in [0, 2^32 s)
[[nodiscard]] ros::Time time_from_ns(std::int64_t t_ns);

/// Grey as mono8, RGB as rgb8, without a header.
[[nodiscard]] ImageMessage message_from(const Image& image);

/// Without a header. Brown's lens is "plumb_bob" (a pinhole too, with zeros), Kannala's is
/// "equidistant". ROS has no name for the FOV lens: its message says "fov" with one coefficient, so
/// that a node that does not know it refuses it instead of rectifying wrongly.
[[nodiscard]] CameraInfoMessage message_from(const PinholeCamera& intrinsics,
                                             const Distortion& distortion);

[[nodiscard]] PoseMessage pose_message_from(const Pose& pose);
[[nodiscard]] TransformMessage transform_message_from(const Pose& pose);
/// Empty when a number is not finite, or the quaternion is off unit length by more than a percent.
[[nodiscard]] std::optional<Pose> pose_from(const PoseMessage& message);
[[nodiscard]] std::optional<Pose> pose_from(const TransformMessage& message);

/// RGB, made smaller by a whole factor where it exceeds the size. Knows mono8, 8UC1, rgb8, bgr8,
/// 8UC3 (as bgr8), rgba8 and bgra8.
/// Errors: kUnreadable naming the encoding or the sizes that do not fit.
[[nodiscard]] Result<Image> rgb_image_from(const ImageMessage& message,
                                           int most_width_px,
                                           int most_height_px);

}  // namespace overfly::ros1
