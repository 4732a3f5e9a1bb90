// Checks the options of the ROS 1 door before any communication.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/motion/pose.hpp"
#include "core/motion/pose_covariance.hpp"
#include "core/result.hpp"
#include "middleware/ros1/master.hpp"
#include "vo_bridges/ros1/ros1_options.hpp"

namespace overfly::ros1 {

/// "pose_stamped", "pose_with_covariance_stamped", "odometry", "tf".
[[nodiscard]] const char* to_string(Ros1PoseType type);

/// @return the master's address
/// Errors: kInvalidArgument naming option, value and limit.
[[nodiscard]] Result<XmlRpcAddress> check(const Ros1EstimatorOptions& options);

/// The options that determine how the estimator's answers are interpreted.
[[nodiscard]] std::map<std::string, std::string> effective(const Ros1EstimatorOptions& options);

/// Converts a pose as published by the node to T_vo_camera with optical axes.
[[nodiscard]] Pose T_vo_camera_from(const Pose& published, const Ros1EstimatorOptions& options);

/// Converts the covariance of a published pose, 36 values row by row, to that of T_vo_camera. The
/// camera's own axes do not matter, because its rotations are about the fixed axes of the parent
/// frame. Invalid values remain invalid. Empty without values.
[[nodiscard]] std::vector<double> covariance_from(const Pose& published,
                                                  std::span<const double> row_major,
                                                  const Ros1EstimatorOptions& options);

}  // namespace overfly::ros1
