// What of a ROS graph an estimator has for itself: two that share any of it would hear each other's
// images, or answer for each other.
#pragma once

#include <string>
#include <vector>

#include "vo_bridges/ros1/ros1_estimator.hpp"

namespace overfly::ros1 {

struct OwnTopic {
  const char* option;  ///< that names it
  std::string name;
  bool is_transform = false;  ///< "FRAME in FRAME on /tf": others may be on /tf beside it
};

/// Without the slash before it: "world" and "/world" name the same frame (tf2 knows no leading
/// slash, tf had one), and the same topic where there is no ROS_NAMESPACE.
[[nodiscard]] inline std::string bare_name(const std::string& name) {
  return name.starts_with('/') ? name.substr(1) : name;
}

/// What an estimator of these options has for itself; /clock is not of it.
[[nodiscard]] inline std::vector<OwnTopic> own_topics(const Ros1EstimatorOptions& options) {
  std::vector<OwnTopic> own = {{"image_topic", options.image_topic},
                               {"camera_info_topic", options.camera_info_topic}};
  const bool by_tf = options.pose_type == Ros1PoseType::kTf;
  if (!by_tf) own.push_back({"pose_topic", options.pose_topic});
  if (!options.debug_image_topic.empty()) {
    own.push_back({"debug_image_topic", options.debug_image_topic});
  }
  if (!options.reset_topic.empty()) own.push_back({"reset_topic", options.reset_topic});
  if (by_tf || options.publish_tf) {
    own.push_back(
        {"camera_frame",
         bare_name(options.camera_frame) + " in " + bare_name(options.vo_frame) + " on /tf",
         true});
  }
  return own;
}

}  // namespace overfly::ros1
