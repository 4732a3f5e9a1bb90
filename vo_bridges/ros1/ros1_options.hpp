// What the door checks of its options before it speaks to anybody.
#pragma once

#include <map>
#include <string>

#include "vo_bridges/ros1/ros1_estimator.hpp"
#include "vo_bridges/ros1/ros1_master.hpp"

namespace overfly::ros1 {

/// "pose_stamped", "pose_with_covariance_stamped", "odometry", "tf".
[[nodiscard]] const char* to_string(Ros1PoseType type);

/// @return the master's address
/// Errors: kInvalidArgument naming option, value and limit.
[[nodiscard]] Result<XmlRpcAddress> check(const Ros1EstimatorOptions& options);

/// What of the options tells how the estimator's answers are understood.
[[nodiscard]] std::map<std::string, std::string> effective(const Ros1EstimatorOptions& options);

/// T_vo_camera, optical axes, of a pose as the node publishes it.
[[nodiscard]] Pose T_vo_camera_from(const Pose& published, const Ros1EstimatorOptions& options);

}  // namespace overfly::ros1
