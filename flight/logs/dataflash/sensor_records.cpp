#include "flight/logs/dataflash/sensor_records.hpp"

#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <string_view>

#include "core/motion/pose.hpp"

namespace overfly::flight::logs {
namespace {

constexpr double kIcePointK = 273.15;
constexpr double kNotLogged = std::numeric_limits<double>::quiet_NaN();

struct SensorRecordName {
  std::string_view name;
  SensorRecord kind;
  int rank;
};

constexpr SensorRecordName kSensorRecords[] = {
    {"IMU", SensorRecord::kImu, 0},
    {"IMU2", SensorRecord::kImu, 1},
    {"IMU3", SensorRecord::kImu, 2},
    {"BARO", SensorRecord::kBarometer, 0},
    {"BAR2", SensorRecord::kBarometer, 1},
    {"GPS", SensorRecord::kGps, 0},
    {"GPS2", SensorRecord::kGps, 1},
    {"ARSP", SensorRecord::kAirspeed, 0},
    {"MAG", SensorRecord::kMagnetometer, 0},
    {"MAG2", SensorRecord::kMagnetometer, 1},
    {"MAG3", SensorRecord::kMagnetometer, 2},
    {"RFND", SensorRecord::kRange, 0},
};

bool find_fields(const RecordFormat& format,
                 std::initializer_list<const char*> names,
                 SensorPlan& plan) {
  std::size_t i = 0;
  for (const char* const name : names) {
    const RecordField* const field = format.field(name);
    if (field == nullptr) return false;
    plan.fields[i++] = *field;
  }
  return true;
}

std::optional<RecordField> field_named(const RecordFormat& format, const char* name) {
  const RecordField* const field = format.field(name);
  return field != nullptr ? std::optional(*field) : std::nullopt;
}

bool find_sensor_fields(const RecordFormat& format, SensorPlan& plan) {
  switch (plan.kind) {
    case SensorRecord::kImu:
      return find_fields(format, {"GyrX", "GyrY", "GyrZ", "AccX", "AccY", "AccZ"}, plan);
    case SensorRecord::kBarometer:
      return find_fields(format, {"Press", "Temp"}, plan);
    case SensorRecord::kGps:
      plan.first_extra = field_named(format, "VZ");
      return find_fields(format, {"Status", "Lat", "Lng", "Alt", "Spd", "GCrs"}, plan);
    case SensorRecord::kAirspeed:
      return find_fields(format, {"Airspeed", "DiffPress"}, plan);
    case SensorRecord::kMagnetometer:
      return find_fields(format, {"MagX", "MagY", "MagZ"}, plan);
    case SensorRecord::kRange:
      plan.first_extra = field_named(format, "Orient");
      plan.second_extra = field_named(format, "Stat");
      return find_fields(format, {"Dist"}, plan);
    case SensorRecord::kNone:
      break;
  }
  return false;
}

GpsSample gps_in(const SensorPlan& plan, std::span<const std::uint8_t> record, std::int64_t t_ns) {
  GpsSample sample;
  sample.t_ns = t_ns;
  sample.delivered_ns = t_ns;
  sample.velocity_ned_m_s.setConstant(kNotLogged);
  sample.horizontal_accuracy_m = kNotLogged;
  sample.vertical_accuracy_m = kNotLogged;
  sample.speed_accuracy_m_s = kNotLogged;
  const auto value = [&](std::size_t i) { return number_in(plan.fields[i], record); };
  const bool on_earth = std::abs(value(1)) <= 90.0 && std::abs(value(2)) <= 180.0;
  if (!(value(0) >= 3.0) || !on_earth || !std::isfinite(value(3))) {
    sample.fix = GpsFixType::kNone;
    sample.place = {kNotLogged, kNotLogged, kNotLogged};
    return sample;
  }
  sample.place = geodetic_from_deg(value(1), value(2), value(3));
  const double course_rad = rad_from_deg(value(5));
  sample.velocity_ned_m_s = {value(4) * std::cos(course_rad),
                             value(4) * std::sin(course_rad),
                             plan.first_extra ? number_in(*plan.first_extra, record) : kNotLogged};
  return sample;
}

/// Of RFND: no value if nothing was measured downwards.
std::optional<double> range_in(const SensorPlan& plan, std::span<const std::uint8_t> record) {
  constexpr std::int64_t kLooksDown = 25;  // ROTATION_PITCH_270
  constexpr std::int64_t kOutOfRangeLow = 2;
  constexpr std::int64_t kGood = 4;
  if (plan.first_extra && integer_in(*plan.first_extra, record) != kLooksDown) return std::nullopt;
  const std::int64_t state =
      plan.second_extra ? integer_in(*plan.second_extra, record) : std::int64_t{kGood};
  if (state < kOutOfRangeLow) return std::nullopt;
  if (state < kGood) return std::numeric_limits<double>::infinity();
  const double range_m = number_in(plan.fields[0], record);
  return range_m >= 0.0 ? std::optional(range_m) : std::nullopt;
}

}  // namespace

SensorPlan sensor_plan_of(const RecordFormat& format) {
  for (const SensorRecordName& candidate : kSensorRecords) {
    if (candidate.name != format.name) continue;
    SensorPlan plan;
    plan.kind = candidate.kind;
    plan.rank = candidate.rank;
    if (find_sensor_fields(format, plan)) return plan;
  }
  return {};
}

SensorSamples samples_in(const SensorPlan& plan,
                         std::span<const std::uint8_t> record,
                         std::int64_t t_ns) {
  SensorSamples samples;
  const auto value = [&](std::size_t i) { return number_in(plan.fields[i], record); };
  switch (plan.kind) {
    case SensorRecord::kImu: {
      const Eigen::Vector3d rate(value(0), value(1), value(2));
      const Eigen::Vector3d force(value(3), value(4), value(5));
      if (rate.allFinite() && force.allFinite()) samples.imu.push_back({t_ns, force, rate});
      break;
    }
    case SensorRecord::kBarometer:
      if (value(0) > 0.0) samples.barometer.push_back({t_ns, value(0), value(1) + kIcePointK});
      break;
    case SensorRecord::kGps:
      samples.gps.push_back(gps_in(plan, record, t_ns));
      break;
    case SensorRecord::kAirspeed:
      if (std::isfinite(value(0)) && std::isfinite(value(1))) {
        samples.airspeed.push_back({t_ns, value(1), value(0)});
      }
      break;
    case SensorRecord::kMagnetometer: {
      // FMTU declares gauss, with a multiplier; older logs have milligauss without a unit.
      const double ut_per_unit = plan.fields[0].unit == "Gauss" ? 100.0 : 0.1;
      const Eigen::Vector3d field = ut_per_unit * Eigen::Vector3d(value(0), value(1), value(2));
      if (field.allFinite() && !field.isZero(0.0)) samples.magnetometer.push_back({t_ns, field});
      break;
    }
    case SensorRecord::kRange:
      if (const auto range_m = range_in(plan, record)) samples.range.push_back({t_ns, *range_m});
      break;
    case SensorRecord::kNone:
      break;
  }
  return samples;
}

}  // namespace overfly::flight::logs
