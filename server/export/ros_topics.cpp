#include "server/export/ros_topics.hpp"

#include <utility>

namespace overfly::server {

std::vector<RosCameraTopics> ros_camera_topics(const std::vector<CameraSpec>& cameras) {
  std::vector<std::string> names;
  for (const CameraSpec& camera : cameras) names.push_back(camera.name);
  std::vector<RosCameraTopics> topics;
  for (const std::string& part : camera_topic_parts(names)) {
    const std::string prefix = "/" + part;
    topics.push_back(
        {prefix + "/image_raw", prefix + "/camera_info", prefix + "/truth", optical_frame(part)});
  }
  return topics;
}

RosEstimates::RosEstimates(const std::vector<PlannedEstimate>& estimates)
    : estimates_(estimates), next_(estimates.size(), 0) {
  std::vector<std::string> names;
  for (const PlannedEstimate& estimate : estimates) names.push_back(estimate.track.name);
  names_ = topic_parts(names);
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
