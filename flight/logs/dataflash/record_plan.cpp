#include "flight/logs/dataflash/record_plan.hpp"

#include <string_view>

#include "core/motion/pose.hpp"
#include "flight/logs/mode_names.hpp"
#include "flight/logs/ned_attitude.hpp"

namespace overfly::flight::logs {
namespace {

struct RecordSource {
  std::string_view name;
  SourceOrigin origin;
  int preference;
};

/// Records that give positions or attitudes. POS and ATT are what the autopilot itself uses; XKF1
/// and XKQ are of EKF3, NKF1 and NKQ of EKF2, EKF1 of the first one; AHR2 is the fallback without
/// EKF.
constexpr RecordSource kRecordSources[] = {{"SIM", SourceOrigin::kSimulation, 0},
                                           {"SIM2", SourceOrigin::kSimulation, 1},
                                           {"POS", SourceOrigin::kEstimate, 0},
                                           {"ATT", SourceOrigin::kEstimate, 0},
                                           {"XKF1", SourceOrigin::kEstimate, 1},
                                           {"XKQ", SourceOrigin::kEstimate, 1},
                                           {"NKF1", SourceOrigin::kEstimate, 2},
                                           {"NKQ", SourceOrigin::kEstimate, 2},
                                           {"EKF1", SourceOrigin::kEstimate, 3},
                                           {"AHR2", SourceOrigin::kEstimate, 4},
                                           {"GPS", SourceOrigin::kGps, 0},
                                           {"GPS2", SourceOrigin::kGps, 1},
                                           {"GPSB", SourceOrigin::kGps, 1}};

struct EventRecord {
  std::string_view name;
  EventKind kind;
};

constexpr EventRecord kEventRecords[] = {
    {"MODE", EventKind::kMode},
    {"ARM", EventKind::kArming},
    {"EV", EventKind::kOther},
    {"MSG", EventKind::kText},
    {"CAM", EventKind::kCamera},
    {"TRIG", EventKind::kCamera},
    {"ERR", EventKind::kOther},
    {"CMD", EventKind::kMission},
};

template <std::size_t N>
std::optional<std::array<RecordField, N>> fields_named(const RecordFormat& format,
                                                       const std::array<const char*, N>& names) {
  std::array<RecordField, N> found;
  for (std::size_t i = 0; i < N; ++i) {
    const RecordField* const field = format.field(names[i]);
    if (field == nullptr) return std::nullopt;
    found[i] = *field;
  }
  return found;
}

void find_time(RecordPlan& plan) {
  struct TimeField {
    const char* name;
    std::int64_t ns;
  };
  // In the oldest records of receivers (GPS, GPS2) TimeMS is the time of the GPS week, and T that
  // of the clock.
  const bool of_week = fields_named<2>(plan.format, {"Week", "T"}).has_value();
  const TimeField names[] = {{of_week ? "T" : "TimeMS", 1'000'000}, {"TimeUS", 1000}};
  for (const TimeField& candidate : names) {
    const RecordField* const field = plan.format.field(candidate.name);
    if (field == nullptr) continue;
    plan.time = *field;
    plan.ns_per_time_unit = candidate.ns;
  }
}

void find_source(RecordPlan& plan) {
  const RecordFormat& format = plan.format;
  const RecordSource* source = nullptr;
  for (const RecordSource& candidate : kRecordSources) {
    if (candidate.name == format.name) source = &candidate;
  }
  if (source == nullptr) return;
  StreamDescription& description = plan.description;
  if (const auto geodetic = fields_named<3>(format, {"Lat", "Lng", "Alt"})) {
    plan.position = *geodetic;
    description.position = PositionKind::kGeodetic;
  } else if (const auto local = fields_named<3>(format, {"PN", "PE", "PD"})) {
    plan.position = *local;
    description.position = PositionKind::kLocal;
  }
  if (format.name == "SIM2") plan.velocity = fields_named<3>(format, {"VN", "VE", "VD"});
  plan.quaternion = fields_named<4>(format, {"Q1", "Q2", "Q3", "Q4"});
  plan.angles = fields_named<3>(format, {"Roll", "Pitch", "Yaw"});
  description.attitude = plan.quaternion || plan.angles;
  if (description.position == PositionKind::kNone && !description.attitude) return;
  if (const RecordField* const status = format.field("Status")) plan.fix = *status;
  description.origin = source->origin;
  description.preference = source->preference;
}

std::string integer_text(const RecordFormat& format,
                         const char* name,
                         std::span<const std::uint8_t> record) {
  const RecordField* const field = format.field(name);
  return field == nullptr ? "?" : std::to_string(integer_in(*field, record));
}

}  // namespace

RecordPlan plan_of(const RecordFormat& format) {
  RecordPlan plan;
  plan.format = format;
  plan.description.name = format.name;
  find_time(plan);
  find_source(plan);
  plan.description.imu = fields_named<3>(format, {"GyrX", "GyrY", "GyrZ"}).has_value() ||
                         fields_named<3>(format, {"AccX", "AccY", "AccZ"}).has_value();
  plan.sensor = sensor_plan_of(format);
  plan.description.sensors = plan.sensor.kind != SensorRecord::kNone;
  for (const EventRecord& candidate : kEventRecords) {
    if (candidate.name == format.name) plan.event = candidate.kind;
  }
  return plan;
}

Eigen::Vector3d vector_in(const std::array<RecordField, 3>& fields,
                          std::span<const std::uint8_t> record) {
  return {number_in(fields[0], record), number_in(fields[1], record), number_in(fields[2], record)};
}

Eigen::Quaterniond attitude_in(const RecordPlan& plan, std::span<const std::uint8_t> record) {
  if (plan.quaternion) {
    const auto& q = *plan.quaternion;
    const Eigen::Quaterniond R_ned_body(number_in(q[0], record),
                                        number_in(q[1], record),
                                        number_in(q[2], record),
                                        number_in(q[3], record));
    // Some versions declare the quaternion and log zeros.
    if (!plan.angles || R_ned_body.squaredNorm() != 0.0) return R_ned_body;
  }
  const bool radians = (*plan.angles)[0].unit == "rad";
  const Eigen::Vector3d angles =
      vector_in(*plan.angles, record) * (radians ? 1.0 : rad_from_deg(1.0));
  return R_ned_body_from({angles.x(), angles.y(), angles.z()});
}

std::string event_text(const RecordPlan& plan,
                       std::span<const std::uint8_t> record,
                       bool is_ardu_plane) {
  const RecordFormat& format = plan.format;
  switch (*plan.event) {
    case EventKind::kMode: {
      const RecordField* const mode = format.field("Mode");
      return mode == nullptr ? "mode" : mode_text(integer_in(*mode, record), is_ardu_plane);
    }
    case EventKind::kArming: {
      const RecordField* const state = format.field("ArmState");
      return state != nullptr && integer_in(*state, record) != 0 ? "armed" : "disarmed";
    }
    case EventKind::kText: {
      const RecordField* const text = format.field("Message");
      return text == nullptr ? "" : text_in(*text, record);
    }
    case EventKind::kMission:
      return "mission item " + integer_text(format, "CNum", record) + ", command " +
             integer_text(format, "CId", record);
    case EventKind::kCamera:
      return format.field("Img") == nullptr ? "picture"
                                            : "picture " + integer_text(format, "Img", record);
    case EventKind::kOther:
      break;
  }
  if (format.name == "ERR") {
    return "error of subsystem " + integer_text(format, "Subsys", record) + ", code " +
           integer_text(format, "ECode", record);
  }
  return "event " + integer_text(format, "Id", record);
}

}  // namespace overfly::flight::logs
