// Samples of sensors in PX4 topics. Private to ulog.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/sensors/sensor_samples.hpp"
#include "flight/logs/ulog/ulog_format.hpp"

namespace overfly::flight::logs {

enum class UlogSensor { kNone, kImu, kBarometer, kGps, kAirspeed, kMagnetometer, kRange };

/// The fields of a topic with samples of a sensor, in the order of ulog_sensors.cpp.
struct SensorTopicPlan {
  UlogSensor kind = UlogSensor::kNone;
  int preference = 0;  ///< of the topics of one sensor the smaller the better
  std::array<std::optional<UlogField>, 8> fields;
  std::optional<UlogField> sampled;  ///< timestamp_sample
  /// Of a GPS: latitude, longitude [deg], height above mean sea level [m], with these factors.
  std::array<UlogField, 3> position;
  std::array<double, 3> position_scale{1.0, 1.0, 1.0};
};

/// sensor_combined; vehicle_air_data, sensor_baro; vehicle_gps_position, sensor_gps; airspeed,
/// airspeed_validated; vehicle_magnetometer, sensor_mag; distance_sensor. Of one sensor the first
/// is the best, then the lowest instance. The position of a GPS is left to the caller.
[[nodiscard]] SensorTopicPlan sensor_plan_of(const UlogFormats& formats,
                                             const std::string& topic,
                                             std::uint8_t instance);

/// The sample of a message, in SI units and body axes (PX4's are forward-right-down); heights above
/// mean sea level. Its time is timestamp_sample where the topic has it; that of the IMU is the
/// middle of gyro_integral_dt, which ends at the timestamp. A pressure below 2000 is one in
/// millibar, as sensor_baro had it up to PX4 1.13. Where only the airspeed is logged, its pressure
/// follows.
/// @param t_ns  `timestamp`
/// @return without a sample if the message has none that can be right; empty for a distance in
/// another direction than down
/// @pre the plan is not kNone
[[nodiscard]] std::optional<SensorSamples> sensor_samples_in(const SensorTopicPlan& plan,
                                                             std::span<const std::uint8_t> data,
                                                             std::int64_t t_ns);

}  // namespace overfly::flight::logs
