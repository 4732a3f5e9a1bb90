#include "server/net/foxglove/channels.hpp"

#include "server/ros2/flight_names.hpp"
#include "server/ros2/ros2_flight.hpp"
#include "server/ros2/ros2_message.hpp"

namespace overfly::net::foxglove {

FlightNames names_of(const std::vector<server::RunCamera>& cameras,
                     const std::vector<std::string>& estimators) {
  std::vector<std::string> called;
  for (const server::RunCamera& camera : cameras) called.push_back(camera.name);
  FlightNames names;
  for (const std::string& part : server::camera_topic_parts(called)) {
    names.cameras.push_back({"/" + part, server::optical_frame(part)});
  }
  for (const std::string& part : server::topic_parts(estimators)) {
    names.estimates.push_back({"/estimates/" + part, part + "_camera", part + "_vo"});
  }
  return names;
}

std::vector<Channel> channels_of(const FlightNames& names, std::uint32_t first_id) {
  using Kind = ChannelKind;
  std::vector<Channel> channels;
  const auto add =
      [&](const std::string& topic, Kind kind, std::size_t index, const server::Ros2Type& type) {
        const auto id = first_id + static_cast<std::uint32_t>(channels.size());
        channels.push_back({id, topic, kind, index, &type});
      };
  add("/tf", Kind::kTransforms, 0, server::kRos2TfMessage);
  add("/rosout", Kind::kLog, 0, server::kRos2Log);
  add("/truth/path", Kind::kTruthPath, 0, server::kRos2Path);
  add("/truth/fix", Kind::kTruthFix, 0, server::kRos2NavSatFix);
  for (std::size_t i = 0; i < names.cameras.size(); ++i) {
    const std::string& topics = names.cameras[i].topics;
    add(topics + "/truth", Kind::kCameraTruth, i, server::kRos2PoseStamped);
    add(topics + "/camera_info", Kind::kCameraInfo, i, server::kRos2CameraInfo);
    add(topics + "/image_raw/compressed", Kind::kCameraImage, i, server::kRos2CompressedImage);
  }
  for (std::size_t i = 0; i < names.estimates.size(); ++i) {
    const std::string& topics = names.estimates[i].topics;
    add(topics + "/pose", Kind::kPose, i, server::kRos2PoseStamped);
    add(topics + "/pose_world", Kind::kWorldPose, i, server::kRos2PoseStamped);
    add(topics + "/path", Kind::kPath, i, server::kRos2Path);
    add(topics + "/fix", Kind::kFix, i, server::kRos2NavSatFix);
    add(topics + "/state", Kind::kState, i, server::kRos2EstimateState);
    add(topics + "/points", Kind::kPoints, i, server::kRos2PointCloud);
    add(topics + "/debug/compressed", Kind::kDebugImage, i, server::kRos2CompressedImage);
  }
  return channels;
}

}  // namespace overfly::net::foxglove
