#include "server/export/ros_topics.hpp"

#include <set>
#include <utility>

namespace overfly::server {
namespace {

/// Letters, digits and '_'; unlike the names so far.
std::string topic_part(std::string name, std::set<std::string>& taken) {
  for (char& c : name) {
    const bool word = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!word) c = '_';
  }
  const std::string wanted = name;
  for (int i = 2; !taken.insert(name).second; ++i) name = wanted + "_" + std::to_string(i);
  return name;
}

}  // namespace

std::vector<RosCameraTopics> ros_camera_topics(const std::vector<CameraSpec>& cameras) {
  std::vector<RosCameraTopics> names;
  std::set<std::string> taken;
  for (const CameraSpec& camera : cameras) {
    const std::string prefix = topic_part(taken.empty() ? "camera" : camera.name, taken);
    names.push_back({"/" + prefix + "/image_raw",
                     "/" + prefix + "/camera_info",
                     "/" + prefix + "/truth",
                     prefix + "_optical_frame"});
  }
  return names;
}

std::vector<RosMount> ros_mounts(const CameraSpec& first_camera, const std::string& camera_frame) {
  // Forward-right-down and forward-left-up are half a turn about x apart.
  const Eigen::Quaterniond R_body_base(0.0, 1.0, 0.0, 0.0);
  const Pose T_camera_body = first_camera.T_body_camera.inverse();
  // Columns are the range sensor's axes in base_link: x down, y left, z forward.
  Eigen::Matrix3d R_base_range;
  R_base_range << 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0;
  return {
      {ros1::kBodyFrame, camera_frame, T_camera_body * Pose{R_body_base, Eigen::Vector3d::Zero()}},
      {ros1::kRangeFrame,
       ros1::kBodyFrame,
       Pose{Eigen::Quaterniond(R_base_range), Eigen::Vector3d::Zero()}}};
}

RosEstimates::RosEstimates(const std::vector<PlannedEstimate>& estimates)
    : estimates_(estimates), next_(estimates.size(), 0) {
  std::set<std::string> taken;
  for (const PlannedEstimate& estimate : estimates) {
    names_.push_back(topic_part(estimate.track.name, taken));
  }
}

std::vector<std::string> RosEstimates::topics() const {
  std::vector<std::string> topics;
  for (std::size_t i = 0; i < estimates_.size(); ++i) {
    topics.push_back("/estimates/" + names_[i] + "/pose");
    if (estimates_[i].S_world_vo) topics.push_back("/estimates/" + names_[i] + "/pose_world");
  }
  return topics;
}

std::vector<RosEstimate> RosEstimates::of(std::int64_t frame) {
  std::vector<RosEstimate> poses;
  for (std::size_t i = 0; i < estimates_.size(); ++i) {
    const PlannedEstimate& estimate = estimates_[i];
    const std::vector<EstimateSample>& samples = estimate.track.samples;
    std::size_t& next = next_[i];
    while (next < samples.size() && samples[next].frame < frame) ++next;
    if (next == samples.size() || samples[next].frame != frame) continue;
    const EstimateSample& sample = samples[next];
    if (sample.state != TrackingState::kTracking) continue;
    const std::string topic = "/estimates/" + names_[i] + "/pose";
    poses.push_back({topic, names_[i] + "_vo", sample.t_ns, sample.T_vo_camera});
    if (!estimate.S_world_vo || sample.map_id != estimate.map_id) continue;
    poses.push_back({topic + "_world",
                     ros1::kWorldFrame,
                     sample.t_ns,
                     *estimate.S_world_vo * sample.T_vo_camera});
  }
  return poses;
}

}  // namespace overfly::server
