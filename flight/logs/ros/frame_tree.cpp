#include "flight/logs/ros/frame_tree.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "flight/logs/ros/ros_messages.hpp"

namespace overfly::flight::logs {
namespace {

constexpr const char* kBaseFrame = "base_link";
/// Frames between a camera and the body; more are a loop.
constexpr int kMaxDepth = 16;

/// tf of ROS 1 began names with a slash.
std::string bare_frame(std::string_view name) {
  if (name.starts_with('/')) name.remove_prefix(1);
  return std::string(name);
}

/// Frames by REP-105 in which an aircraft moves.
bool is_of_the_world(const std::string& frame) {
  constexpr std::array<std::string_view, 4> kFrames = {"world", "map", "odom", "earth"};
  return std::find(kFrames.begin(), kFrames.end(), frame) != kFrames.end();
}

}  // namespace

bool is_transform_type(std::string_view name) {
  return name == "tf2_msgs/TFMessage" || name == "tf2_msgs/msg/TFMessage" || name == "tf/tfMessage";
}

void FrameTree::see(std::string_view frame) {
  if (frame.starts_with('/')) frame.remove_prefix(1);
  if (seen_.size() < kMaxFrames && seen_.find(frame) == seen_.end()) seen_.emplace(frame);
}

void FrameTree::take(RosCursor message) {
  const auto count = message.number<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::string parent = bare_frame(take_header(message).frame_id);
    const std::string child = bare_frame(message.text());
    Pose T_parent_child;
    for (double& component : T_parent_child.translation) component = message.number<double>();
    for (double& component : T_parent_child.rotation.coeffs()) component = message.number<double>();
    if (!message.ok()) return;
    const double norm = T_parent_child.rotation.norm();
    if (!T_parent_child.translation.allFinite() || !(norm >= 0.9 && norm <= 1.1)) continue;
    T_parent_child.rotation.normalize();
    see(parent);
    see(child);
    if (links_.size() < kMaxFrames || links_.contains(child)) {
      links_[child] = {parent, T_parent_child};
    }
  }
}

std::vector<FrameTree::Ancestor> FrameTree::ancestors_of(const std::string& from) const {
  std::vector<Ancestor> ancestors = {{from, Pose()}};
  for (int depth = 0; depth < kMaxDepth; ++depth) {
    const auto link = links_.find(ancestors.back().frame);
    if (link == links_.end() || is_of_the_world(link->second.parent)) break;
    ancestors.push_back(
        {link->second.parent, link->second.T_parent_child * ancestors.back().T_frame_from});
  }
  return ancestors;
}

std::optional<Pose> FrameTree::mount_of(const std::string& camera_frame) const {
  const std::vector<Ancestor> of_camera = ancestors_of(camera_frame);
  for (const Ancestor& base : ancestors_of(kBaseFrame)) {
    for (const Ancestor& camera : of_camera) {
      if (base.frame != camera.frame) continue;
      return camera.T_frame_from.inverse() * base.T_frame_from;
    }
  }
  return std::nullopt;
}

Pose T_camera_base_nadir() {
  const Eigen::Quaterniond R_frd_flu(0.0, 1.0, 0.0, 0.0);
  return {R_body_camera_nadir().conjugate() * R_frd_flu, Eigen::Vector3d::Zero()};
}

}  // namespace overfly::flight::logs
