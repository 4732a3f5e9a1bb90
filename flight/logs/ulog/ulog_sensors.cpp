// After the definitions of PX4's uORB topics (msg/ of PX4-Autopilot, versions 1.8 to 1.16).
#include "flight/logs/ulog/ulog_sensors.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "core/sensors/measured_samples.hpp"
#include "core/time.hpp"

namespace overfly::flight::logs {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kUtPerGa = 100.0;
constexpr double kCelsiusZeroK = 273.15;

struct SensorTopicFacts {
  std::string_view name;
  UlogSensor kind;
  int rank;
  std::size_t needed;  ///< of the fields; the others may be missing
  std::array<const char*, 8> fields;
};

constexpr SensorTopicFacts kSensorTopics[] = {
    {"sensor_combined",
     UlogSensor::kImu,
     0,
     2,
     {"gyro_rad", "accelerometer_m_s2", "gyro_integral_dt", "accelerometer_timestamp_relative"}},
    {"vehicle_air_data",
     UlogSensor::kBarometer,
     0,
     1,
     {"baro_pressure_pa", "baro_temp_celcius", "ambient_temperature"}},
    {"sensor_baro", UlogSensor::kBarometer, 1, 1, {"pressure", "temperature"}},
    {"vehicle_gps_position",
     UlogSensor::kGps,
     0,
     1,
     {"fix_type",
      "vel_n_m_s",
      "vel_e_m_s",
      "vel_d_m_s",
      "vel_ned_valid",
      "eph",
      "epv",
      "s_variance_m_s"}},
    {"sensor_gps",
     UlogSensor::kGps,
     1,
     1,
     {"fix_type",
      "vel_n_m_s",
      "vel_e_m_s",
      "vel_d_m_s",
      "vel_ned_valid",
      "eph",
      "epv",
      "s_variance_m_s"}},
    {"airspeed", UlogSensor::kAirspeed, 0, 1, {"indicated_airspeed_m_s"}},
    {"airspeed_validated", UlogSensor::kAirspeed, 1, 1, {"indicated_airspeed_m_s"}},
    {"vehicle_magnetometer", UlogSensor::kMagnetometer, 0, 1, {"magnetometer_ga"}},
    {"sensor_mag", UlogSensor::kMagnetometer, 1, 3, {"x", "y", "z"}},
    {"distance_sensor",
     UlogSensor::kRange,
     0,
     3,
     {"current_distance", "max_distance", "orientation", "signal_quality"}},
};

/// The numbers of one message.
class UlogValues {
 public:
  UlogValues(const SensorTopicPlan& plan, std::span<const std::uint8_t> data)
      : plan_(plan), data_(data) {}

  /// NaN if the message does not have it.
  [[nodiscard]] double value(std::size_t field, std::size_t i = 0) const {
    const std::optional<UlogField>& of = plan_.fields[field];
    return of ? number_in(*of, data_, i).value_or(kNoNumber) : kNoNumber;
  }
  [[nodiscard]] Eigen::Vector3d vector(std::size_t field) const {
    return {value(field, 0), value(field, 1), value(field, 2)};
  }
  /// Positive, or NaN.
  [[nodiscard]] double accuracy(std::size_t field) const {
    const double number = value(field);
    return number > 0.0 && std::isfinite(number) ? number : kNoNumber;
  }
  /// When it was measured, if the message says so.
  [[nodiscard]] std::int64_t sampled_ns(std::int64_t t_ns) const {
    return sampled_ns_in(plan_.sampled, data_, t_ns);
  }
  [[nodiscard]] double position(std::size_t i) const {
    return number_in(plan_.position[i], data_).value_or(kNoNumber) * plan_.position_scale[i];
  }

 private:
  const SensorTopicPlan& plan_;
  std::span<const std::uint8_t> data_;
};

void add_imu_of(const UlogValues& message,
                const SensorTopicPlan& plan,
                std::int64_t t_ns,
                SensorSamples& samples) {
  constexpr double kNoAcceleration = 2147483647.0;  // RELATIVE_TIMESTAMP_INVALID
  if (message.value(3) == kNoAcceleration) return;
  ImuSample sample{t_ns, message.vector(1), message.vector(0)};
  // In seconds up to PX4 1.8, in microseconds since.
  const bool in_seconds = plan.fields[2] && plan.fields[2]->type == "float";
  const double interval_s = message.value(2) * (in_seconds ? 1.0 : 1e-6);
  if (interval_s > 0.0 && interval_s <= 1.0) {
    sample.interval_ns = ns_from_s(interval_s);
    sample.t_ns -= sample.interval_ns / 2;
  }
  (void)add_measured(samples, sample);
}

void add_pressure_of(const UlogValues& message, std::int64_t t_ns, SensorSamples& samples) {
  constexpr double kMostMillibar = 2000.0;
  const double pressure = message.value(0);
  const double sensor_c = message.value(1);
  const double celsius = std::isnan(sensor_c) ? message.value(2) : sensor_c;
  (void)add_measured(samples,
                     BarometerSample{message.sampled_ns(t_ns),
                                     pressure < kMostMillibar ? 100.0 * pressure : pressure,
                                     celsius + kCelsiusZeroK});
}

void add_fix_of(const UlogValues& message, std::int64_t t_ns, SensorSamples& samples) {
  GpsSample sample = gps_without_fix(message.sampled_ns(t_ns), t_ns);
  if (message.value(0) >= 3.0) {
    sample.fix = GpsFixType::k3d;
    sample.place = geodetic_from_deg(message.position(0), message.position(1), message.position(2));
    if (message.value(4) != 0.0) {
      sample.velocity_ned_m_s = {message.value(1), message.value(2), message.value(3)};
    }
    sample.horizontal_accuracy_m = message.accuracy(5);
    sample.vertical_accuracy_m = message.accuracy(6);
    sample.speed_accuracy_m_s = message.accuracy(7);
  }
  (void)add_measured(samples, sample);
}

/// @return whether the sensor looks down
bool add_distance_of(const UlogValues& message, std::int64_t t_ns, SensorSamples& samples) {
  constexpr double kLooksDown = 25.0;  // ROTATION_DOWNWARD_FACING
  constexpr double kNoSignal = 0.0;
  if (message.value(2) != kLooksDown) return false;
  const double distance_m = message.value(0);
  const double most_m = message.value(1);
  const bool out_of_range = most_m > 0.0 && distance_m >= most_m;
  const bool echo = message.value(3) != kNoSignal && !out_of_range;
  (void)add_measured(
      samples, RangeSample{t_ns, echo ? distance_m : std::numeric_limits<double>::infinity()});
  return true;
}

}  // namespace

SensorTopicPlan sensor_plan_of(const UlogFormats& formats,
                               const std::string& topic,
                               std::uint8_t instance) {
  constexpr int kInstances = 256;
  SensorTopicPlan plan;
  for (const SensorTopicFacts& facts : kSensorTopics) {
    if (facts.name != topic) continue;
    bool complete = true;
    for (std::size_t i = 0; i < facts.fields.size() && facts.fields[i] != nullptr; ++i) {
      plan.fields[i] = formats.find(topic, facts.fields[i]);
      complete = complete && (i >= facts.needed || plan.fields[i]);
    }
    if (!complete) return {};
    plan.kind = facts.kind;
    plan.preference = kInstances * facts.rank + instance;
    plan.sampled = formats.find(topic, "timestamp_sample");
  }
  return plan;
}

std::optional<SensorSamples> sensor_samples_in(const SensorTopicPlan& plan,
                                               std::span<const std::uint8_t> data,
                                               std::int64_t t_ns) {
  const UlogValues message(plan, data);
  SensorSamples samples;
  switch (plan.kind) {
    case UlogSensor::kImu:
      add_imu_of(message, plan, t_ns, samples);
      break;
    case UlogSensor::kBarometer:
      add_pressure_of(message, t_ns, samples);
      break;
    case UlogSensor::kGps:
      add_fix_of(message, t_ns, samples);
      break;
    case UlogSensor::kAirspeed:
      (void)add_measured(samples, airspeed_of_speed(message.sampled_ns(t_ns), message.value(0)));
      break;
    case UlogSensor::kMagnetometer: {
      const bool apart = plan.fields[2].has_value();
      const Eigen::Vector3d gauss =
          apart ? Eigen::Vector3d(message.value(0), message.value(1), message.value(2))
                : message.vector(0);
      (void)add_measured(samples, MagnetometerSample{message.sampled_ns(t_ns), kUtPerGa * gauss});
      break;
    }
    case UlogSensor::kRange:
      if (!add_distance_of(message, t_ns, samples)) return std::nullopt;
      break;
    case UlogSensor::kNone:
      break;
  }
  return samples;
}

}  // namespace overfly::flight::logs
