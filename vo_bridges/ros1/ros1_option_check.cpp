#include "vo_bridges/ros1/ros1_option_check.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

#include "vo_bridges/ros1/own_topics.hpp"

namespace overfly::ros1 {
namespace {

Error bad_option(const std::string& option, const std::string& value, const std::string& limit) {
  return {ErrorCode::kInvalidArgument, option + " = " + value + ": " + limit};
}

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

/// Whether a name is a ROS graph name: letters, digits, _ and /, starting with a letter or a slash.
bool is_graph_name(const std::string& name) {
  return (name.front() == '/' || std::isalpha(static_cast<unsigned char>(name.front())) != 0) &&
         name.back() != '/' && name.find("//") == std::string::npos &&
         std::all_of(name.begin(), name.end(), [](char c) { return is_word(c) || c == '/'; });
}

Status check_name(const std::string& option, const std::string& name, bool may_be_empty) {
  if (may_be_empty && name.empty()) return {};
  if (!name.empty() && is_graph_name(name)) return {};
  return bad_option(
      option,
      "'" + name + "'",
      "must be a ROS name of letters, digits, _ and / that begins with / or a letter");
}

Status check_seconds(const std::string& option, double value) {
  if (value > 0.0 && value <= 3600.0) return {};
  return bad_option(option, std::to_string(value), "must be in (0, 3600]");
}

Status check_names(const Ros1EstimatorOptions& options) {
  const struct {
    const char* option;
    const std::string& name;
    bool may_be_empty;
  } names[] = {
      {"image_topic", options.image_topic, false},
      {"camera_info_topic", options.camera_info_topic, false},
      {"pose_topic", options.pose_topic, options.pose_type == Ros1PoseType::kTf},
      {"debug_image_topic", options.debug_image_topic, true},
      {"sensor_namespace", options.sensor_namespace, false},
      {"parameter_namespace", options.parameter_namespace, options.parameters.empty()},
  };
  for (const auto& [option, name, may_be_empty] : names) {
    if (Status status = check_name(option, name, may_be_empty); !status) return status;
  }
  if (options.node_name.empty() ||
      !std::isalpha(static_cast<unsigned char>(options.node_name[0])) ||
      !std::all_of(options.node_name.begin(), options.node_name.end(), is_word)) {
    return bad_option("node_name",
                      "'" + options.node_name + "'",
                      "must be of letters, digits and _, and begin with a letter");
  }
  const std::vector<OwnTopic> own = own_topics(options);
  for (std::size_t i = 0; i < own.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (bare_name(own[i].name) != bare_name(own[k].name)) continue;
      return bad_option(
          own[i].option, own[i].name, std::string("must not be the ") + own[k].option);
    }
  }
  return {};
}

Status check_frames(const Ros1EstimatorOptions& options) {
  if (options.camera_frame.empty()) return bad_option("camera_frame", "''", "must not be empty");
  const bool needs_vo_frame = options.publish_tf || options.pose_type == Ros1PoseType::kTf;
  if (needs_vo_frame && options.vo_frame.empty()) {
    return bad_option("vo_frame", "''", "must not be empty");
  }
  if (needs_vo_frame && options.vo_frame == options.camera_frame) {
    return bad_option("vo_frame", "'" + options.vo_frame + "'", "must not be the camera_frame");
  }
  if (options.publish_tf && options.pose_type == Ros1PoseType::kTf) {
    return bad_option("publish_tf", "true", "must be false where the pose comes by TF");
  }
  return {};
}

}  // namespace

const char* to_string(Ros1PoseType type) {
  switch (type) {
    case Ros1PoseType::kPoseStamped:
      return "pose_stamped";
    case Ros1PoseType::kPoseWithCovarianceStamped:
      return "pose_with_covariance_stamped";
    case Ros1PoseType::kOdometry:
      return "odometry";
    case Ros1PoseType::kTf:
      break;
  }
  return "tf";
}

Result<XmlRpcAddress> check(const Ros1EstimatorOptions& options) {
  auto master = parse_xml_rpc_address(options.master_uri);
  if (!master) return Error{master.error().code, "master_uri = " + master.error().message};
  if (Status status = check_names(options); !status) return status.error();
  if (Status status = check_frames(options); !status) return status.error();
  if (options.queue_size < 1 || options.queue_size > 1000) {
    return bad_option("queue_size", std::to_string(options.queue_size), "must be in [1, 1000]");
  }
  if (Status status = check_seconds("start_timeout_s", options.start_timeout_s); !status) {
    return status.error();
  }
  if (Status status = check_seconds("answer_timeout_s", options.answer_timeout_s); !status) {
    return status.error();
  }
  return master;
}

std::map<std::string, std::string> effective(const Ros1EstimatorOptions& options) {
  const auto text = [](bool value) { return value ? "true" : "false"; };
  return {{"ros1.pose_type", to_string(options.pose_type)},
          {"ros1.pose_is_camera_from_world", text(options.pose_is_camera_from_world)},
          {"ros1.pose_in_body_axes", text(options.pose_in_body_axes)},
          {"ros1.lockstep", text(options.lockstep)}};
}

Pose T_vo_camera_from(const Pose& published, const Ros1EstimatorOptions& options) {
  Pose T = options.pose_is_camera_from_world ? published.inverse() : published;
  if (options.pose_in_body_axes) {
    // The optical axes (right, down, forward) in the body frame (forward, left, up).
    Eigen::Matrix3d R_body_optical;
    R_body_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    T.rotation = T.rotation * Eigen::Quaterniond(R_body_optical);
  }
  return T;
}

std::vector<double> covariance_from(const Pose& published,
                                    std::span<const double> row_major,
                                    const Ros1EstimatorOptions& options) {
  std::vector<double> values(row_major.begin(), row_major.end());
  if (!options.pose_is_camera_from_world || values.size() != 36) return values;
  using RowMajor = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  Eigen::Map<RowMajor> matrix(values.data());
  matrix = inverted_covariance(published, matrix);
  return values;
}

}  // namespace overfly::ros1
