// After the definitions of common_msgs (ROS 1) and common_interfaces (ROS 2), and REP-103.
#include "flight/logs/ros/ros_messages.hpp"

#include <algorithm>
#include <cctype>
#include <string>

#include "core/time.hpp"
#include "flight/logs/ned_attitude.hpp"
#include "flight/logs/ros/frame_words.hpp"
#include "flight/logs/ros/ros_sensors.hpp"

namespace overfly::flight::logs {
namespace {

struct RosTypeFacts {
  std::string_view package;
  std::string_view name;
  RosType type;
  PositionKind position;
  bool attitude;
  int preference;
  bool sensors = false;
};

constexpr RosTypeFacts kRosTypes[] = {
    {"nav_msgs", "Odometry", RosType::kOdometry, PositionKind::kLocal, true, 0},
    {"geometry_msgs", "PoseStamped", RosType::kPoseStamped, PositionKind::kLocal, true, 1},
    {"sensor_msgs", "NavSatFix", RosType::kNavSatFix, PositionKind::kGeodetic, false, 0, true},
    {"sensor_msgs", "Imu", RosType::kImu, PositionKind::kNone, true, 2, true},
    {"sensor_msgs", "MagneticField", RosType::kMagneticField, PositionKind::kNone, false, 0, true},
    {"sensor_msgs", "FluidPressure", RosType::kFluidPressure, PositionKind::kNone, false, 0, true},
    {"sensor_msgs", "Range", RosType::kRange, PositionKind::kNone, false, 0, true},
    {"sensor_msgs", "Image", RosType::kImage, PositionKind::kNone, false, 0},
    {"sensor_msgs", "CompressedImage", RosType::kCompressedImage, PositionKind::kNone, false, 0},
};

/// REP-103.
bool is_optical_frame(std::string_view frame) {
  return frame.ends_with("_optical_frame") || frame.ends_with("_optical");
}

Eigen::Vector3d take_vector(RosCursor& message) {
  Eigen::Vector3d value;
  for (double& component : value) component = message.number<double>();
  return value;
}

Eigen::Quaterniond take_quaternion(RosCursor& message) {
  Eigen::Vector4d xyzw;
  for (double& component : xyzw) component = message.number<double>();
  return Eigen::Quaterniond(xyzw);
}

Eigen::Vector3d ned_position(std::string_view world, const Eigen::Vector3d& p) {
  if (ends_with_word(world, "ned")) return p;
  return {p.y(), p.x(), -p.z()};
}

Eigen::Quaterniond ned_attitude(std::string_view world,
                                std::string_view body,
                                const Eigen::Quaterniond& R_world_body) {
  // Both changes of axes are half turns, which are their own inverses.
  const Eigen::Quaterniond R_flu_frd(0.0, 1.0, 0.0, 0.0);
  Eigen::Quaterniond R = R_world_body;
  if (!ends_with_word(body, "frd")) R = R * R_flu_frd;
  if (!ends_with_word(world, "ned")) R = R_enu_ned() * R;
  return R;
}

void take_pose(RosCursor& message,
               std::string_view world,
               std::string_view body,
               RosSample& sample) {
  sample.position = ned_position(world, take_vector(message));
  sample.R_ned_body = ned_attitude(world, body, take_quaternion(message));
}

void take_fix(RosCursor message, RosSample& sample) {
  const auto status = message.number<std::int8_t>();
  (void)message.number<std::uint16_t>();  // service
  sample.position = take_vector(message);
  sample.invalid = status < 0;
}

void take_orientation(RosCursor& message, std::string_view body, RosSample& sample) {
  const Eigen::Quaterniond R_world_body = take_quaternion(message);
  const bool known = message.number<double>() != -1.0;
  for (int i = 1; i < 9; ++i) (void)message.number<double>();  // the rest of its covariance
  if (known) sample.R_ned_body = ned_attitude("", body, R_world_body);
}

}  // namespace

RosType ros_type_named(std::string_view name) {
  for (const RosTypeFacts& facts : kRosTypes) {
    if (!name.starts_with(facts.package) || !name.ends_with(facts.name)) continue;
    const std::size_t ends = facts.package.size() + facts.name.size();
    if (name.size() <= ends) continue;
    const std::string_view middle = name.substr(facts.package.size(), name.size() - ends);
    if (middle == "/" || middle == "/msg/") return facts.type;
  }
  return RosType::kOther;
}

StreamDescription describe_topic(std::string_view topic, RosType type) {
  StreamDescription description;
  description.name = topic;
  description.imu = type == RosType::kImu;
  for (const RosTypeFacts& facts : kRosTypes) {
    if (facts.type != type) continue;
    description.position = facts.position;
    description.attitude = facts.attitude;
    description.preference = facts.preference;
    description.sensors = facts.sensors && !ros_topic_name(topic).is_truth;
  }
  if (description.position == PositionKind::kNone && !description.attitude) return description;
  if (type == RosType::kNavSatFix) description.height = HeightDatum::kEllipsoid;
  if (ros_topic_name(topic).is_truth) {
    description.origin = SourceOrigin::kSimulation;
  } else {
    description.origin = type == RosType::kNavSatFix ? SourceOrigin::kGps : SourceOrigin::kEstimate;
  }
  return description;
}

RosTopicName ros_topic_name(std::string_view topic) {
  std::string lower(topic);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) {
    return static_cast<char>(std::tolower(c));
  });
  const auto has = [&lower](const char* word) { return lower.find(word) != std::string::npos; };
  return {has("truth"), has("raw"), has("diff_press") || has("differential_press")};
}

std::optional<RosSample> decode_ros(RosType type, RosCursor message, const RosTopicName& topic) {
  const RosHeader header = take_header(message);
  const RosSensorHeader sensor{header.stamp_ns, header.frame_id, topic.is_differential};
  RosSample sample;
  sample.stamp_ns = header.stamp_ns;
  switch (type) {
    case RosType::kPoseStamped:
      take_pose(message, header.frame_id, "", sample);
      break;
    case RosType::kOdometry: {
      std::string_view child_frame_id = message.text();
      // tf of ROS 1 began names with a slash.
      if (child_frame_id.starts_with('/')) child_frame_id.remove_prefix(1);
      if (is_optical_frame(child_frame_id)) sample.camera_frame = child_frame_id;
      take_pose(message, header.frame_id, child_frame_id, sample);
      break;
    }
    case RosType::kNavSatFix:
      take_fix(message, sample);
      sample.sensors = take_fix_samples(message, sensor);
      break;
    case RosType::kImu:
      take_orientation(message, header.frame_id, sample);
      sample.sensors = take_imu_samples(message, sensor);
      break;
    case RosType::kMagneticField:
      sample.sensors = take_field_samples(message, sensor);
      break;
    case RosType::kFluidPressure:
      sample.sensors = take_pressure_samples(message, sensor);
      break;
    case RosType::kRange:
      sample.sensors = take_range_samples(message, sensor);
      break;
    case RosType::kImage:
    case RosType::kCompressedImage:
      break;
    case RosType::kOther:
      return std::nullopt;
  }
  if (!message.ok()) return std::nullopt;
  return sample;
}

std::optional<RosCursor> ros_cursor_of(std::span<const std::uint8_t> data, RosEncoding encoding) {
  constexpr std::size_t kCdrHeaderBytes = 4;
  if (encoding == RosEncoding::kRos1) return RosCursor(data, encoding, false);
  const bool plain = encoding == RosEncoding::kCdr && data.size() >= kCdrHeaderBytes &&
                     data[0] == 0 && data[1] <= 1;
  if (!plain) return std::nullopt;
  return RosCursor(data.subspan(kCdrHeaderBytes), encoding, data[1] == 0);
}

RosHeader take_header(RosCursor& message) {
  RosHeader header;
  if (message.encoding() == RosEncoding::kRos1) {
    (void)message.number<std::uint32_t>();  // seq
    header.stamp_ns = std::int64_t{message.number<std::uint32_t>()} * kNsPerS;
  } else {
    header.stamp_ns = std::int64_t{message.number<std::int32_t>()} * kNsPerS;
  }
  header.stamp_ns += message.number<std::uint32_t>();
  header.frame_id = message.text();
  return header;
}

}  // namespace overfly::flight::logs
