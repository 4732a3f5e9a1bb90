// Poses of cameras in a recording of ROS messages become those of the aircraft's body. Private to
// ros.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flight/logs/log_sink.hpp"
#include "flight/logs/ros/frame_tree.hpp"
#include "flight/logs/ros/ros_messages.hpp"

namespace overfly::flight::logs {

/// The camera whose poses a topic of PoseStamped has in Overfly's recordings and exports: of
/// "/NAME/truth" "NAME_optical_frame", of "/estimates/NAME/pose" and "/estimates/NAME/pose_world"
/// "camera_optical_frame". Empty: poses of a body.
[[nodiscard]] std::string camera_frame_of(std::string_view topic);

/// The camera poses of one topic.
///
/// A recording may state a camera's mount only after its first poses: they are held until it does,
/// at most kMostHeldPoses of them. If it does not, and a message has named the camera's frame, the
/// camera is taken to look down (T_camera_base_nadir). If no message has, only the topic's name is
/// that of a camera's poses: they are left as they are.
class CameraPoses {
 public:
  using Timed = std::pair<std::optional<LogTime>, std::optional<RosSample>>;
  static constexpr std::size_t kMostHeldPoses = 1024;

  /// Whether a message must be held: it is the next, or one in front of it is held.
  [[nodiscard]] bool must_hold(const std::optional<RosSample>& sample, const FrameTree& frames);
  void hold(const std::optional<LogTime>& time, std::optional<RosSample> sample) {
    held_.emplace_back(time, std::move(sample));
  }
  [[nodiscard]] std::vector<Timed> take_held() { return std::exchange(held_, {}); }
  /// Turns the pose of a camera into that of the body.
  void convert(RosSample& sample, const FrameTree& frames);

  /// The camera that is taken to look down; empty without such poses.
  [[nodiscard]] const std::string& assumed_camera() const { return assumed_camera_; }

 private:
  enum class Mount { kUnknown, kOfFile, kAssumed, kNone };

  Mount mount_ = Mount::kUnknown;
  std::string assumed_camera_;
  std::vector<Timed> held_;
};

}  // namespace overfly::flight::logs
