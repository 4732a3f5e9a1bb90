// Converts samples of an aircraft's sensors to ROS messages.
//
// Orientations and covariances that a sensor does not give are marked as unknown, as the message
// types say.
#pragma once

#include <string>

#include "core/result.hpp"
#include "core/sensors/sensor_samples.hpp"
#include "middleware/ros1/frame_names.hpp"
#include "middleware/ros1/types.hpp"

namespace overfly::ros1 {

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
  const auto with_all = [&](const char* topic, const char* frame, const auto& list, auto convert) {
    for (auto sample = list.begin(); status && sample != list.end(); ++sample) {
      auto message = convert(*sample);
      message.header.frame_id = frame;
      status = take(topic, sample->t_ns, available_ns(*sample), std::move(message));
    }
  };
  const auto as_message = [](const auto& sample) { return message_from(sample); };
  with_all("/sensors/imu", kBodyFrame, samples.imu, as_message);
  with_all("/sensors/pressure", kBodyFrame, samples.barometer, static_pressure_from);
  with_all("/sensors/temperature", kBodyFrame, samples.barometer, temperature_from);
  with_all("/sensors/gps/fix", kBodyFrame, samples.gps, as_message);
  with_all("/sensors/gps/velocity", kWorldFrame, samples.gps, velocity_from);
  with_all("/sensors/airspeed/differential_pressure",
           kBodyFrame,
           samples.airspeed,
           differential_pressure_from);
  with_all("/sensors/magnetic_field", kBodyFrame, samples.magnetometer, as_message);
  with_all("/sensors/range", kRangeFrame, samples.range, as_message);
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
