// Samples of sensors in ROS messages. Private to ros.
#pragma once

#include <cstdint>
#include <string_view>

#include "core/sensors/sensor_samples.hpp"
#include "flight/logs/ros/ros_cursor.hpp"

namespace overfly::flight::logs {

/// What a message says in front of its measurements.
struct RosSensorHeader {
  std::int64_t stamp_ns = 0;
  std::string_view frame_id;
  /// The topic is one of a pressure difference, not of the static pressure.
  bool is_differential = false;
};

/// The measurements of each type, in SI units and body axes. A frame_id whose last word is "frd"
/// has those axes, all others are forward-left-up (REP-103). The cursor is behind the header, of
/// Imu behind the orientation and its covariance. What a message marks as unknown (an element 0 of
/// -1 in a covariance, an acceleration of exactly zero), and what cannot be right, is left out.
[[nodiscard]] SensorSamples take_imu_samples(RosCursor& message, const RosSensorHeader& header);
[[nodiscard]] SensorSamples take_field_samples(RosCursor& message, const RosSensorHeader& header);
/// FluidPressure: a difference gives an airspeed. The temperature is in other messages: NaN.
[[nodiscard]] SensorSamples take_pressure_samples(RosCursor& message,
                                                  const RosSensorHeader& header);
/// NavSatFix: heights above the ellipsoid, delivered when measured; the velocity is in other
/// messages: NaN.
[[nodiscard]] SensorSamples take_fix_samples(RosCursor& message, const RosSensorHeader& header);
/// Range: nothing within the limits is infinity, too close is left out (REP-117).
[[nodiscard]] SensorSamples take_range_samples(RosCursor& message, const RosSensorHeader& header);

}  // namespace overfly::flight::logs
