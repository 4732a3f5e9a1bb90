// Converts samples of an aircraft's sensors to LCM messages.
#pragma once

#include <overfly_lcm/airspeed_t.hpp>
#include <overfly_lcm/barometer_t.hpp>
#include <overfly_lcm/gps_t.hpp>
#include <overfly_lcm/imu_t.hpp>
#include <overfly_lcm/magnetometer_t.hpp>
#include <overfly_lcm/range_t.hpp>

#include "core/result.hpp"
#include "core/sensors/sensor_samples.hpp"

namespace overfly::lcm {

/// Session and sequence stay 0.
[[nodiscard]] overfly_lcm::imu_t message_of(const ImuSample& sample);
[[nodiscard]] overfly_lcm::barometer_t message_of(const BarometerSample& sample);
[[nodiscard]] overfly_lcm::gps_t message_of(const GpsSample& sample);
[[nodiscard]] overfly_lcm::airspeed_t message_of(const AirspeedSample& sample);
[[nodiscard]] overfly_lcm::magnetometer_t message_of(const MagnetometerSample& sample);
[[nodiscard]] overfly_lcm::range_t message_of(const RangeSample& sample);

/// Calls `take(channel, available_ns, message)` for each sample, with the channel's name without
/// prefix. Stops at the first error.
template <typename Take>
[[nodiscard]] Status with_each_message(const SensorSamples& samples, const Take& take) {
  Status status;
  const auto with_all = [&](const char* channel, const auto& list) {
    for (auto sample = list.begin(); status && sample != list.end(); ++sample) {
      status = take(channel, available_ns(*sample), message_of(*sample));
    }
  };
  with_all("IMU", samples.imu);
  with_all("BAROMETER", samples.barometer);
  with_all("GPS", samples.gps);
  with_all("AIRSPEED", samples.airspeed);
  with_all("MAGNETOMETER", samples.magnetometer);
  with_all("RANGE", samples.range);
  return status;
}

}  // namespace overfly::lcm
