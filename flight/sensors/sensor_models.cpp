#include "flight/sensors/sensor_models.hpp"

#include <initializer_list>
#include <utility>

#include "core/text/number_text.hpp"

namespace overfly::flight {
namespace {

struct SensorLimit {
  const char* field;
  double value;
  double min;
  double max;
};

SensorLimit rate_limit(double value, double max_hz = 1000.0) {
  constexpr double kMinHz = 1e-3;
  return {"rate_hz", value, kMinHz, max_hz};
}
SensorLimit error_limit(const char* field, double value) { return {field, value, 0.0, 1e5}; }
SensorLimit drift_time_limit(double value) { return {"drift_time_s", value, 0.1, 1e6}; }

Status check_sensor(const char* sensor, std::initializer_list<SensorLimit> limits) {
  for (const SensorLimit& limit : limits) {
    // False for a value that is not a number.
    if (limit.value >= limit.min && limit.value <= limit.max) continue;
    return Error{ErrorCode::kInvalidArgument,
                 std::string(sensor) + "." + limit.field + " = " + number_text(limit.value) +
                     ": must be in [" + number_text(limit.min) + ", " + number_text(limit.max) +
                     "]"};
  }
  return {};
}

}  // namespace

ImuModel ImuModel::ideal(double rate_hz) { return {rate_hz, 0.0, 0.0, 0.0, 0.0}; }

Status ImuModel::validate() const {
  constexpr double kMaxHz = 10000.0;
  return check_sensor(
      "imu",
      {rate_limit(rate_hz, kMaxHz),
       {"gyroscope_noise_rad_s_sqrt_hz", gyroscope_noise_rad_s_sqrt_hz, 0.0, 1e3},
       {"gyroscope_walk_rad_s2_sqrt_hz", gyroscope_walk_rad_s2_sqrt_hz, 0.0, 1e3},
       {"accelerometer_noise_m_s2_sqrt_hz", accelerometer_noise_m_s2_sqrt_hz, 0.0, 1e3},
       {"accelerometer_walk_m_s3_sqrt_hz", accelerometer_walk_m_s3_sqrt_hz, 0.0, 1e3}});
}

Status SensorModels::validate() const {
  Status status;
  if (imu) status = imu->validate();
  if (status && barometer) {
    const BarometerModel& m = *barometer;
    status = check_sensor("barometer",
                          {rate_limit(m.rate_hz),
                           error_limit("noise_pa", m.noise_pa),
                           error_limit("drift_pa", m.drift_pa),
                           error_limit("temperature_noise_k", m.temperature_noise_k),
                           error_limit("temperature_drift_k", m.temperature_drift_k),
                           drift_time_limit(m.drift_time_s)});
  }
  if (status && gps) {
    const GpsModel& m = *gps;
    status = check_sensor("gps",
                          {rate_limit(m.rate_hz),
                           {"delay_s", m.delay_s, 0.0, 10.0},
                           error_limit("horizontal_drift_m", m.horizontal_drift_m),
                           error_limit("vertical_drift_m", m.vertical_drift_m),
                           drift_time_limit(m.drift_time_s),
                           error_limit("horizontal_noise_m", m.horizontal_noise_m),
                           error_limit("vertical_noise_m", m.vertical_noise_m),
                           error_limit("velocity_noise_m_s", m.velocity_noise_m_s)});
  }
  if (status && airspeed) {
    const AirspeedModel& m = *airspeed;
    status = check_sensor("airspeed",
                          {rate_limit(m.rate_hz),
                           error_limit("noise_pa", m.noise_pa),
                           error_limit("drift_pa", m.drift_pa),
                           drift_time_limit(m.drift_time_s)});
  }
  if (status && magnetometer) {
    const MagnetometerModel& m = *magnetometer;
    status = check_sensor("magnetometer",
                          {rate_limit(m.rate_hz),
                           error_limit("noise_ut", m.noise_ut),
                           error_limit("bias_ut", m.bias_ut)});
  }
  if (status && range) {
    const RangeModel& m = *range;
    status = check_sensor("range",
                          {rate_limit(m.rate_hz),
                           error_limit("noise_m", m.noise_m),
                           {"max_m", m.max_m, 0.1, 1e5},
                           {"min_m", m.min_m, 0.0, 0.999 * m.max_m}});
  }
  return status;
}

}  // namespace overfly::flight
