#include "flight/logs/ros/camera_poses.hpp"

namespace overfly::flight::logs {
namespace {

/// @param sample  with the pose of a camera. Left alone if its attitude is none
void move_to_body(const Pose& T_camera_base, RosSample& sample) {
  if (!sample.position || !sample.R_ned_body) return;
  const double norm = sample.R_ned_body->norm();
  if (!(norm >= 0.9 && norm <= 1.1)) return;
  // As read, the camera's axes were those of a body forward-left-up.
  const Eigen::Quaterniond R_flu_frd(0.0, 1.0, 0.0, 0.0);
  const Pose T_ned_camera{sample.R_ned_body->normalized() * R_flu_frd, *sample.position};
  const Pose T_ned_base = T_ned_camera * T_camera_base;
  sample.position = T_ned_base.translation;
  sample.R_ned_body = T_ned_base.rotation * R_flu_frd;
}

}  // namespace

std::string camera_frame_of(std::string_view topic) {
  constexpr std::string_view kTruth = "/truth";
  if (topic.starts_with("/estimates/") &&
      (topic.ends_with("/pose") || topic.ends_with("/pose_world"))) {
    return "camera_optical_frame";
  }
  if (!topic.ends_with(kTruth)) return {};
  const std::string_view before = topic.substr(0, topic.size() - kTruth.size());
  const std::string_view name = before.substr(before.find_last_of('/') + 1);
  return name.empty() ? std::string() : std::string(name) + "_optical_frame";
}

bool CameraPoses::must_hold(const std::optional<RosSample>& sample, const FrameTree& frames) {
  if (mount_ != Mount::kUnknown || held_.size() >= kMostHeldPoses) return false;
  if (!sample || sample->camera_frame.empty()) return !held_.empty();
  return !frames.mount_of(sample->camera_frame);
}

void CameraPoses::convert(RosSample& sample, const FrameTree& frames) {
  if (sample.camera_frame.empty() || mount_ == Mount::kNone) return;
  const std::optional<Pose> T_camera_base = frames.mount_of(sample.camera_frame);
  if (mount_ == Mount::kUnknown) {
    const bool known = frames.knows(sample.camera_frame);
    mount_ = T_camera_base ? Mount::kOfFile : known ? Mount::kAssumed : Mount::kNone;
    if (mount_ == Mount::kNone) return;
  }
  const bool is_stated = mount_ == Mount::kOfFile && T_camera_base;
  if (!is_stated) assumed_camera_ = sample.camera_frame;
  move_to_body(is_stated ? *T_camera_base : T_camera_base_nadir(), sample);
}

}  // namespace overfly::flight::logs
