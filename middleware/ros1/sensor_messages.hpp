// Converts samples of an aircraft's sensors to ROS messages.
//
// The body is base_link in ROS's axes (REP 103: x forward, y left, z up). Orientations and
// covariances that a sensor does not give are marked as unknown, as the message types say.
#pragma once

#include <string>

#include "core/result.hpp"
#include "core/sensors/sensor_samples.hpp"
#include "middleware/ros1/types.hpp"

namespace overfly::ros1 {

/// frame_id of all messages.
inline constexpr const char* kBodyFrame = "base_link";

[[nodiscard]] ImuMessage message_from(const ImuSample& sample);
[[nodiscard]] FluidPressureMessage static_pressure_from(const BarometerSample& sample);
[[nodiscard]] TemperatureMessage temperature_from(const BarometerSample& sample);
[[nodiscard]] NavSatFixMessage message_from(const GpsSample& sample);
/// East, north, up; NaN without a fix.
[[nodiscard]] TwistStampedMessage velocity_from(const GpsSample& sample);
[[nodiscard]] FluidPressureMessage differential_pressure_from(const AirspeedSample& sample);
[[nodiscard]] MagneticFieldMessage message_from(const MagnetometerSample& sample);
/// The limits of the sensor are not known: 0 and infinity. No echo is infinity (REP 117).
[[nodiscard]] RangeMessage message_from(const RangeSample& sample);

/// Calls `take(topic, measured_ns, available_ns, message)` for each message of the samples; its
/// header has no stamp yet. Stops at the first error.
template <typename Take>
[[nodiscard]] Status with_each_message(const SensorSamples& samples, const Take& take) {
  Status status;
  const auto with_all = [&](const char* topic, const auto& list, auto convert) {
    for (auto sample = list.begin(); status && sample != list.end(); ++sample) {
      std::int64_t available_ns = sample->t_ns;
      if constexpr (requires { sample->delivered_ns; }) available_ns = sample->delivered_ns;
      auto message = convert(*sample);
      message.header.frame_id = kBodyFrame;
      status = take(topic, sample->t_ns, available_ns, std::move(message));
    }
  };
  const auto as_message = [](const auto& sample) { return message_from(sample); };
  with_all("/sensors/imu", samples.imu, as_message);
  with_all("/sensors/pressure", samples.barometer, static_pressure_from);
  with_all("/sensors/temperature", samples.barometer, temperature_from);
  with_all("/sensors/gps/fix", samples.gps, as_message);
  with_all("/sensors/gps/velocity", samples.gps, velocity_from);
  with_all("/sensors/airspeed/differential_pressure", samples.airspeed, differential_pressure_from);
  with_all("/sensors/magnetic_field", samples.magnetometer, as_message);
  with_all("/sensors/range", samples.range, as_message);
  return status;
}

/// Calls `take(topic, Message())` for each topic of with_each_message. Stops at the first error.
template <typename Take>
[[nodiscard]] Status with_each_topic(const Take& take) {
  SensorSamples one;
  one.imu.resize(1);
  one.barometer.resize(1);
  one.gps.resize(1);
  one.airspeed.resize(1);
  one.magnetometer.resize(1);
  one.range.resize(1);
  return with_each_message(one, [&](const char* topic, std::int64_t, std::int64_t, auto message) {
    return take(topic, message);
  });
}

}  // namespace overfly::ros1
