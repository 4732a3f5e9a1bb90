// Converts between Overfly's types and ROS messages.
#pragma once

#include <ros/time.h>

#include <cstdint>
#include <optional>
#include <string>

#include "core/camera/camera.hpp"
#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"
#include "core/motion/pose.hpp"
#include "core/result.hpp"
#include "middleware/ros1/types.hpp"

namespace overfly::ros1 {

/// @pre t_ns is in [0, 2^32 s)
[[nodiscard]] ros::Time time_from_ns(std::int64_t t_ns);

/// Grey as mono8, RGB as rgb8; without header.
[[nodiscard]] ImageMessage message_from(const Image& image);

/// Without header. The radtan (Brown) lens is "plumb_bob" (also a pinhole, with zeros), the
/// Kannala-Brandt lens is "equidistant". ROS has no name for the FOV lens: the message says "fov"
/// with one coefficient, so that a node that does not support it rejects it instead of rectifying
/// wrongly.
[[nodiscard]] CameraInfoMessage message_from(const PinholeCamera& intrinsics,
                                             const Distortion& distortion);

[[nodiscard]] PoseMessage pose_message_from(const Pose& pose);
[[nodiscard]] TransformMessage transform_message_from(const Pose& pose);
/// Empty if a number is not finite or the quaternion's norm differs from 1 by more than a percent.
[[nodiscard]] std::optional<Pose> pose_from(const PoseMessage& message);
[[nodiscard]] std::optional<Pose> pose_from(const TransformMessage& message);

/// Converts to RGB and reduces the size by an integer factor if it exceeds the limit. Supports
/// mono8, 8UC1, rgb8, bgr8, 8UC3 (as bgr8), rgba8 and bgra8.
/// Errors: kUnreadable naming the encoding or the inconsistent sizes.
[[nodiscard]] Result<Image> rgb_image_from(const ImageMessage& message,
                                           int most_width_px,
                                           int most_height_px);

}  // namespace overfly::ros1
