#include "server/ros2/flight_names.hpp"

#include <set>

#include "middleware/ros1/frame_names.hpp"

namespace overfly::server {
namespace {

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

std::vector<std::string> topic_parts(const std::vector<std::string>& names) {
  std::vector<std::string> parts;
  std::set<std::string> taken;
  for (const std::string& name : names) parts.push_back(topic_part(name, taken));
  return parts;
}

std::vector<std::string> camera_topic_parts(const std::vector<std::string>& names) {
  std::vector<std::string> called = names;
  if (!called.empty()) called.front() = "camera";
  return topic_parts(called);
}

std::string optical_frame(const std::string& part) { return part + "_optical_frame"; }

/// Half a turn about x.
Eigen::Quaterniond R_body_base() { return {0.0, 1.0, 0.0, 0.0}; }

std::vector<RosMount> ros_mounts(const Pose& T_body_camera,
                                 const std::string& camera_frame,
                                 bool with_sensors) {
  const Pose T_camera_body = T_body_camera.inverse();
  std::vector<RosMount> mounts = {{ros1::kBodyFrame,
                                   camera_frame,
                                   T_camera_body * Pose{R_body_base(), Eigen::Vector3d::Zero()}}};
  if (!with_sensors) return mounts;
  // Columns are the range sensor's axes in base_link: x down, y left, z forward.
  Eigen::Matrix3d R_base_range;
  R_base_range << 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0;
  mounts.push_back({ros1::kRangeFrame,
                    ros1::kBodyFrame,
                    Pose{Eigen::Quaterniond(R_base_range), Eigen::Vector3d::Zero()}});
  return mounts;
}

}  // namespace overfly::server
