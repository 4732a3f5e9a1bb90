// The parts of the ROS graph that one estimator needs exclusively. Two estimators that share any of
// them would receive each other's images or answers.
#pragma once

#include <vector>

#include "middleware/ros1/own_topic.hpp"
#include "vo_bridges/ros1/ros1_options.hpp"

namespace overfly::ros1 {

/// What an estimator with these options needs exclusively; /clock is shared.
[[nodiscard]] inline std::vector<OwnTopic> own_topics(const Ros1EstimatorOptions& options) {
  std::vector<OwnTopic> own = {{"image_topic", options.image_topic},
                               {"camera_info_topic", options.camera_info_topic}};
  const bool by_tf = options.pose_type == Ros1PoseType::kTf;
  if (!by_tf) own.push_back({"pose_topic", options.pose_topic});
  if (!options.debug_image_topic.empty()) {
    own.push_back({"debug_image_topic", options.debug_image_topic});
  }
  if (options.publish_sensors) own.push_back({"sensor_namespace", options.sensor_namespace});
  if (by_tf || options.publish_tf) {
    own.push_back(
        {"camera_frame",
         bare_name(options.camera_frame) + " in " + bare_name(options.vo_frame) + " on /tf",
         true});
  }
  return own;
}

}  // namespace overfly::ros1
