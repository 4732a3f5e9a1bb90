#include "flight/logs/ulog/ulog_topics.hpp"

#include <string_view>

namespace overfly::flight::logs {
namespace {

struct TopicFacts {
  std::string_view name;
  SourceOrigin origin;
  int preference;
};

/// Topics that give positions or attitudes.
constexpr TopicFacts kTopics[] = {
    {"vehicle_global_position_groundtruth", SourceOrigin::kSimulation, 0},
    {"vehicle_local_position_groundtruth", SourceOrigin::kSimulation, 1},
    {"vehicle_attitude_groundtruth", SourceOrigin::kSimulation, 0},
    {"vehicle_global_position", SourceOrigin::kEstimate, 0},
    {"vehicle_local_position", SourceOrigin::kEstimate, 1},
    {"vehicle_attitude", SourceOrigin::kEstimate, 0},
    {"vehicle_gps_position", SourceOrigin::kGps, 0},
    {"sensor_gps", SourceOrigin::kGps, 1}};

constexpr std::string_view kImuTopics[] = {
    "sensor_combined", "sensor_accel", "sensor_gyro", "vehicle_imu"};

bool find_topic_position(TopicPlan& plan,
                         const UlogFormats& formats,
                         const std::string& topic,
                         const std::array<const char*, 3>& names) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::optional<UlogField> field = formats.find(topic, names[i]);
    if (!field) return false;
    plan.position[i] = *field;
  }
  return true;
}

/// Flags of the topics that are the truth of a simulation are not used: PX4's bridge to Gazebo
/// fills the values of these topics and leaves all flags 0.
void find_topic_source(TopicPlan& plan,
                       const UlogFormats& formats,
                       const std::string& topic,
                       SourceOrigin origin) {
  StreamDescription& description = plan.description;
  if (find_topic_position(
          plan, formats, topic, {"latitude_deg", "longitude_deg", "altitude_msl_m"})) {
    description.position = PositionKind::kGeodetic;
  } else if (find_topic_position(plan, formats, topic, {"lat", "lon", "alt"})) {
    description.position = PositionKind::kGeodetic;
    if (plan.position[0].type == "int32_t") plan.position_scale = {1e-7, 1e-7, 1e-3};
  } else if (find_topic_position(plan, formats, topic, {"x", "y", "z"})) {
    description.position = PositionKind::kLocal;
    plan.origin = {formats.find(topic, "ref_lat"),
                   formats.find(topic, "ref_lon"),
                   formats.find(topic, "ref_alt")};
  }
  if (origin == SourceOrigin::kEstimate && description.position == PositionKind::kGeodetic) {
    plan.valid = {formats.find(topic, "lat_lon_valid"), formats.find(topic, "alt_valid")};
  } else if (origin == SourceOrigin::kEstimate && description.position == PositionKind::kLocal) {
    plan.valid = {formats.find(topic, "xy_valid"), formats.find(topic, "z_valid")};
    plan.origin_valid = {formats.find(topic, "xy_global"), formats.find(topic, "z_global")};
  }
  plan.quaternion = formats.find(topic, "q");
  if (plan.quaternion && plan.quaternion->count != 4) plan.quaternion.reset();
  description.attitude = plan.quaternion.has_value();
  plan.fix = formats.find(topic, "fix_type");
}

bool all_true(const std::array<std::optional<UlogField>, 2>& flags,
              std::span<const std::uint8_t> data) {
  for (const std::optional<UlogField>& flag : flags) {
    if (flag && number_in(*flag, data).value_or(0.0) == 0.0) return false;
  }
  return true;
}

}  // namespace

TopicPlan plan_of(const UlogFormats& formats, const std::string& topic, std::uint8_t instance) {
  TopicPlan plan;
  plan.description.name = topic + "[" + std::to_string(instance) + "]";
  plan.time = formats.find(topic, "timestamp");
  for (const std::string_view name : kImuTopics) {
    if (name == topic) plan.description.imu = true;
  }
  if (topic == "vehicle_status") {
    plan.mode = formats.find(topic, "nav_state");
    plan.arming = formats.find(topic, "arming_state");
  }
  for (const TopicFacts& facts : kTopics) {
    if (facts.name != topic) continue;
    find_topic_source(plan, formats, topic, facts.origin);
    if (plan.description.position == PositionKind::kNone && !plan.description.attitude) break;
    plan.description.origin = facts.origin;
    plan.sampled = formats.find(topic, "timestamp_sample");
    plan.description.preference = 10 * facts.preference + instance;
  }
  plan.sensor = sensor_plan_of(formats, topic, instance);
  if (plan.sensor.kind == UlogSensor::kGps) {
    if (plan.description.position != PositionKind::kGeodetic) plan.sensor = {};
    plan.sensor.position = plan.position;
    plan.sensor.position_scale = plan.position_scale;
  }
  plan.description.sensors = plan.sensor.kind != UlogSensor::kNone;
  return plan;
}

std::optional<LocalOrigin> origin_in(const TopicPlan& plan, std::span<const std::uint8_t> data) {
  std::array<double, 3> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!plan.origin[i]) return std::nullopt;
    const std::optional<double> value = number_in(*plan.origin[i], data);
    if (!value || !(*value >= -1000.0 && *value <= 100000.0)) return std::nullopt;
    values[i] = *value;
  }
  if (!all_true(plan.origin_valid, data) || (values[0] == 0.0 && values[1] == 0.0)) {
    return std::nullopt;
  }
  return LocalOrigin{values[0], values[1], values[2], LocalGrid::kPx4};
}

void pass_samples(const TopicPlan& plan,
                  std::span<const std::uint8_t> data,
                  StreamId id,
                  const LogTime& time,
                  LogSink& sink) {
  if (!all_true(plan.valid, data)) return sink.no_sample(id);
  if (plan.fix && number_in(*plan.fix, data).value_or(0.0) < 3.0) return sink.no_sample(id);
  if (plan.description.position != PositionKind::kNone) {
    Eigen::Vector3d value;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::optional<double> number = number_in(plan.position[i], data);
      if (!number) return sink.no_sample(id);
      value[static_cast<Eigen::Index>(i)] = *number * plan.position_scale[i];
    }
    sink.position(id, time, value);
  }
  if (!plan.quaternion) return;
  std::array<double, 4> q{};
  for (std::size_t i = 0; i < q.size(); ++i) {
    const std::optional<double> number = number_in(*plan.quaternion, data, i);
    if (!number) return sink.no_sample(id);
    q[i] = *number;
  }
  sink.attitude(id, time, Eigen::Quaterniond(q[0], q[1], q[2], q[3]));
}

}  // namespace overfly::flight::logs
