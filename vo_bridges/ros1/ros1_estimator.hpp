// An estimator in a ROS 1 node: images are published on topics, and poses are received from topics
// (vo_bridges/ros1/README.md).
#pragma once

#include <memory>

#include "core/result.hpp"
#include "vo_bridges/ros1/ros1_options.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly {

/// Waits for the master, then for a subscriber of the images or the calibration.
/// Errors: kUnsupported if ROS 1 is not built in; kInvalidArgument naming the option; kNotFound if
/// no master answers or no node subscribes to the images in time; kConflict if this process is
/// already a node of another master, or another of its estimators uses a topic; kCancelled.
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_ros1_estimator(
    const Ros1EstimatorOptions& options);

}  // namespace overfly
