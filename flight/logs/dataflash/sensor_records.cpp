#include "flight/logs/dataflash/sensor_records.hpp"

#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <string_view>

#include "core/motion/pose.hpp"
#include "core/sensors/measured_samples.hpp"

namespace overfly::flight::logs {
namespace {

constexpr double kIcePointK = 273.15;

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
  GpsSample sample = gps_without_fix(t_ns, t_ns);
  const auto value = [&](std::size_t i) { return number_in(plan.fields[i], record); };
  if (!(value(0) >= 3.0)) return sample;
  sample.fix = GpsFixType::k3d;
  sample.place = geodetic_from_deg(value(1), value(2), value(3));
  const double course_rad = rad_from_deg(value(5));
  sample.velocity_ned_m_s.x() = value(4) * std::cos(course_rad);
  sample.velocity_ned_m_s.y() = value(4) * std::sin(course_rad);
  if (plan.first_extra) sample.velocity_ned_m_s.z() = number_in(*plan.first_extra, record);
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
  return number_in(plan.fields[0], record);
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
    case SensorRecord::kImu:
      (void)add_measured(
          samples, ImuSample{t_ns, {value(3), value(4), value(5)}, {value(0), value(1), value(2)}});
      break;
    case SensorRecord::kBarometer:
      (void)add_measured(samples, BarometerSample{t_ns, value(0), value(1) + kIcePointK});
      break;
    case SensorRecord::kGps:
      (void)add_measured(samples, gps_in(plan, record, t_ns));
      break;
    case SensorRecord::kAirspeed:
      (void)add_measured(samples, AirspeedSample{t_ns, value(1), value(0)});
      break;
    case SensorRecord::kMagnetometer: {
      // FMTU declares gauss, with a multiplier; older logs have milligauss without a unit.
      const double ut_per_unit = plan.fields[0].unit == "Gauss" ? 100.0 : 0.1;
      const Eigen::Vector3d field = ut_per_unit * Eigen::Vector3d(value(0), value(1), value(2));
      (void)add_measured(samples, MagnetometerSample{t_ns, field});
      break;
    }
    case SensorRecord::kRange:
      if (const auto range_m = range_in(plan, record)) {
        (void)add_measured(samples, RangeSample{t_ns, *range_m});
      }
      break;
    case SensorRecord::kNone:
      break;
  }
  return samples;
}

}  // namespace overfly::flight::logs
