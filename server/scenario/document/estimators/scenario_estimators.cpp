#include "server/scenario/document/estimators/scenario_estimators.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "middleware/lcm/network.hpp"
#include "server/scenario/document/scenario_faults.hpp"
#include "server/scenario/document/scenario_field.hpp"
#include "server/scenario/document/scenario_layers.hpp"
#include "vo_bridges/lcm/lcm_options.hpp"
#include "vo_bridges/ros1/own_topics.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// The estimator types that have a field.
struct FieldUse {
  const char* field;
  bool native;
  bool process;
  bool lcm;
  bool ros1;
};
constexpr std::array<FieldUse, 8> kFieldUses = {{{"command", false, true, false, false},
                                                 {"listen", false, true, false, false},
                                                 {"memory_limit_mb", false, true, false, false},
                                                 {"cpus", true, true, false, false},
                                                 {"start_timeout_s", false, true, true, true},
                                                 {"answer_timeout_s", false, true, true, true},
                                                 {"lcm", false, false, true, false},
                                                 {"ros1", false, false, false, true}}};

bool used_by(const FieldUse& use, const std::string& type) {
  if (type == "process") return use.process;
  if (type == "lcm") return use.lcm;
  return type == "ros1" ? use.ros1 : use.native;
}

Status check_uses(const Json& entry, const std::string& type, const std::string& path) {
  for (const FieldUse& use : kFieldUses) {
    const auto given = entry.find(use.field);
    if (given == entry.end() || used_by(use, type)) continue;
    return bad_field(path + "." + use.field, *given, "be left out if type is " + type);
  }
  if (type != "process") return {};
  if (!entry.contains("command") && !entry.contains("listen")) {
    return Error{ErrorCode::kInvalidArgument,
                 path + ".command: must be given if type is process (or listen instead)"};
  }
  for (const char* of_child : {"cpus", "memory_limit_mb"}) {
    if (!entry.contains(of_child) || entry.contains("command")) continue;
    return bad_field(
        path + "." + of_child, entry.at(of_child), "be left out without a command to start");
  }
  return {};
}

/// A program given as a path is relative to the scenario's folder. So is an argument that begins
/// with `./` or `../`.
std::string absolute_argument(const std::string& argument, bool program, const fs::path& base) {
  const bool path = argument.starts_with("./") || argument.starts_with("../") ||
                    (program && argument.find('/') != std::string::npos);
  return path ? (base / argument).lexically_normal().string() : argument;
}

Status read_command(Json& command,
                    const std::string& path,
                    const fs::path& base,
                    EstimatorSpec& spec) {
  for (std::size_t i = 0; i < command.size(); ++i) {
    const std::string text = command[i].get<std::string>();
    const std::string where = path + "." + std::to_string(i);
    if (i == 0 && text.empty()) return bad_field(where, text, "name a program");
    if (text.find('\0') != std::string::npos) return bad_field(where, text, "hold no NUL");
    spec.command.push_back(absolute_argument(text, i == 0, base));
    command[i] = spec.command.back();
  }
  return {};
}

void read_listen(Json& listen, const fs::path& base, EstimatorSpec& spec) {
  const std::string scheme = "unix:";
  spec.listen = listen.get<std::string>();
  if (!spec.listen.starts_with(scheme)) return;
  const fs::path socket = base / spec.listen.substr(scheme.size());
  spec.listen = scheme + socket.lexically_normal().string();
  listen = spec.listen;
}

VoParameters parameters_from(const Json& parameters) {
  VoParameters values;
  for (const auto& [name, value] : parameters.items()) {
    if (value.is_boolean()) {
      values[name] = value.get<bool>();
    } else if (value.is_string()) {
      values[name] = value.get<std::string>();
    } else {
      values[name] = value.get<double>();
    }
  }
  return values;
}

Ros1PoseType pose_type_from(const std::string& text) {
  if (text == "pose_with_covariance_stamped") return Ros1PoseType::kPoseWithCovarianceStamped;
  if (text == "odometry") return Ros1PoseType::kOdometry;
  return text == "tf" ? Ros1PoseType::kTf : Ros1PoseType::kPoseStamped;
}

Ros1EstimatorOptions ros1_from(const Json& ros1) {
  Ros1EstimatorOptions options;
  options.master_uri = ros1.at("master_uri").get<std::string>();
  options.node_name = ros1.at("node_name").get<std::string>();
  options.image_topic = ros1.at("image_topic").get<std::string>();
  options.camera_info_topic = ros1.at("camera_info_topic").get<std::string>();
  options.pose_topic = ros1.at("pose_topic").get<std::string>();
  options.pose_type = pose_type_from(ros1.at("pose_type").get<std::string>());
  options.sensor_namespace = ros1.at("sensor_namespace").get<std::string>();
  options.debug_image_topic = ros1.at("debug_image_topic").get<std::string>();
  options.camera_frame = ros1.at("camera_frame").get<std::string>();
  options.vo_frame = ros1.at("vo_frame").get<std::string>();
  options.pose_is_camera_from_world = ros1.at("pose_is_camera_from_world").get<bool>();
  options.pose_in_body_axes = ros1.at("pose_in_body_axes").get<bool>();
  options.publish_tf = ros1.at("publish_tf").get<bool>();
  options.parameter_namespace = ros1.at("parameter_namespace").get<std::string>();
  options.publish_clock = ros1.at("publish_clock").get<bool>();
  options.queue_size = ros1.at("queue_size").get<int>();
  return options;
}

/// Reads the fields that only outside estimators have.
Status read_door(Json& entry, const std::string& path, const fs::path& base, EstimatorSpec& spec) {
  if (entry.contains("command")) {
    const Status read = read_command(entry.at("command"), path + ".command", base, spec);
    if (!read) return read;
  }
  if (entry.contains("listen")) read_listen(entry.at("listen"), base, spec);
  spec.memory_limit_mb = number_or_none(entry, "memory_limit_mb").value_or(0.0);
  spec.start_timeout_s = number_or_none(entry, "start_timeout_s");
  spec.answer_timeout_s = number_or_none(entry, "answer_timeout_s");
  if (entry.contains("lcm")) {
    spec.lcm_url = entry.at("lcm").at("url").get<std::string>();
    spec.lcm_channel_prefix = entry.at("lcm").at("channel_prefix").get<std::string>();
  }
  if (entry.contains("ros1")) spec.ros1 = ros1_from(entry.at("ros1"));
  return {};
}

Result<EstimatorSpec> read_estimator(Json& entry,
                                     const std::string& path,
                                     const fs::path& base,
                                     const Scenario& scenario) {
  EstimatorSpec spec;
  spec.name = entry.at("name").get<std::string>();
  spec.type = entry.at("type").get<std::string>();
  if (Status status = check_uses(entry, spec.type, path); !status) return status.error();
  spec.parameters = parameters_from(entry.at("parameters"));
  if (entry.contains("camera")) {
    const auto camera = camera_index(scenario, entry.at("camera"), path + ".camera");
    if (!camera) return camera.error();
    spec.camera = *camera;
  }
  if (entry.contains("cpus")) spec.cpus = entry.at("cpus").get<std::vector<int>>();
  spec.throttle_hz = number_or_none(entry, "throttle_hz").value_or(0.0);
  if (spec.throttle_hz > 0.0 && scenario.pacing == Pacing::kLockstep) {
    return bad_field(path + ".throttle_hz",
                     entry.at("throttle_hz"),
                     "be left out if pacing is lockstep, which drops nothing");
  }
  if (Status status = read_door(entry, path, base, spec); !status) return status.error();
  return spec;
}

/// Channels of an estimator on LCM.
struct LcmChannels {
  std::string network;
  std::string prefix;
  bool operator==(const LcmChannels&) const = default;
};

LcmChannels lcm_channels(const EstimatorSpec& spec) {
  const LcmEstimatorOptions plain;
  return {lcm::network_of(spec.lcm_url.empty() ? plain.url : spec.lcm_url),
          spec.lcm_channel_prefix.empty() ? plain.channel_prefix : spec.lcm_channel_prefix};
}

/// Two estimators with shared channels would receive each other's data.
Status check_apart(EstimatorSpec spec,
                   EstimatorSpec other,
                   bool with_sensors,
                   const std::string& path) {
  spec.ros1.publish_sensors = other.ros1.publish_sensors = with_sensors;
  const std::string who = "\"" + other.name + "\" and \"" + spec.name + "\"";
  if (spec.type == "lcm" && other.type == "lcm" && lcm_channels(spec) == lcm_channels(other)) {
    const auto [network, prefix] = lcm_channels(spec);
    return bad_field(path + ".lcm.channel_prefix",
                     prefix,
                     "differ between estimators " + who + ", which are both on " + network);
  }
  if (spec.type != "ros1" || other.type != "ros1") return {};
  for (const ros1::OwnTopic& mine : ros1::own_topics(spec.ros1)) {
    for (const ros1::OwnTopic& known : ros1::own_topics(other.ros1)) {
      if (ros1::bare_name(mine.name) != ros1::bare_name(known.name)) continue;
      return bad_field(path + ".ros1." + mine.option,
                       mine.name,
                       "not be the " + std::string(known.option) + " of another: estimators " +
                           who + " each need one of their own");
    }
  }
  return {};
}

}  // namespace

Status read_estimators(Json& document, const fs::path& base, Scenario& scenario) {
  std::set<std::string> names;
  for (Json& entry : document.at("estimators")) {
    const std::string path = "estimators." + std::to_string(scenario.estimators.size());
    Result<EstimatorSpec> spec = read_estimator(entry, path, base, scenario);
    if (!spec) return spec.error();
    if (!names.insert(spec->name).second) {
      return bad_field(path + ".name", spec->name, "be unique");
    }
    for (const EstimatorSpec& other : scenario.estimators) {
      Status apart = check_apart(*spec, other, scenario.has_sensors(), path);
      if (!apart) return apart;
    }
    scenario.estimators.push_back(std::move(*spec));
  }
  return {};
}

}  // namespace overfly::server
