// The frames of a recording of ROS messages, as its transforms state them. Private to ros.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/motion/pose.hpp"
#include "flight/logs/ros/ros_cursor.hpp"

namespace overfly::flight::logs {

/// Whether a type is that of the topics /tf and /tf_static: tf2_msgs/TFMessage, tf/tfMessage.
[[nodiscard]] bool is_transform_type(std::string_view name);

/// The latest transforms between at most kMaxFrames frames.
class FrameTree {
 public:
  static constexpr std::size_t kMaxFrames = 256;

  /// Takes the transforms of a message. What ends early or is no rotation is left out.
  void take(RosCursor message);
  /// A message has this frame.
  void see(std::string_view frame);

  /// Number of frames and transforms known so far.
  [[nodiscard]] std::size_t size() const { return seen_.size() + links_.size(); }
  /// Whether any message or transform has named the frame.
  [[nodiscard]] bool knows(const std::string& frame) const { return seen_.contains(frame); }
  /// T_camera_base: the aircraft's body in ROS's axes (base_link: forward, left, up) as seen from a
  /// camera. Empty if the transforms so far do not connect both.
  [[nodiscard]] std::optional<Pose> mount_of(const std::string& camera_frame) const;

 private:
  struct Link {
    std::string parent;
    Pose T_parent_child;
  };
  struct Ancestor {
    std::string frame;
    Pose T_frame_from;
  };
  /// A frame and those above it, as far as they move with it: not the world.
  [[nodiscard]] std::vector<Ancestor> ancestors_of(const std::string& from) const;

  std::map<std::string, Link> links_;  ///< by the child
  std::set<std::string, std::less<>> seen_;
};

/// T_camera_base of a camera that looks down with the top of its image to the nose, at the body's
/// origin: the mount of Overfly's cameras if nothing else is said.
[[nodiscard]] Pose T_camera_base_nadir();

}  // namespace overfly::flight::logs
