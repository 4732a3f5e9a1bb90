// The measurements of a vehicle's sensors in its MAVLink messages.
#pragma once

#include <cstdint>
#include <optional>

#include "core/sensors/sensor_samples.hpp"
#include "flight/mavlink/frame.hpp"
#include "flight/mavlink/messages.hpp"

namespace overfly::flight::mavlink {

/// What the samples of a message depend on in addition to the message.
struct SensorContext {
  std::int64_t latest_ns = 0;       ///< the vehicle's clock: its latest time so far
  std::uint8_t autopilot = 0;       ///< MAV_AUTOPILOT
  double geoid_separation_m = 0.0;  ///< added to the GPS's heights above mean sea level
};

/// The samples of one message.
struct MessageSamples {
  /// Of two messages with samples of one sensor, that with the lower number is the better one.
  int preference = 0;
  SensorSamples samples;  ///< times of the vehicle's clock; at most one of each sensor
};

/// Whether sensor_samples_of() reads messages of this id.
[[nodiscard]] bool may_have_samples(MessageId id);

/// The samples in a message, in order of preference:
///   IMU, magnetometer:  HIGHRES_IMU, RAW_IMU (of ArduPilot: its definition leaves units open),
///                       SCALED_IMU, SCALED_IMU2, SCALED_IMU3
///   barometer:          HIGHRES_IMU, SCALED_PRESSURE
///   airspeed:           AIRSPEED, VFR_HUD
///   GPS:                GPS_RAW_INT, GPS2_RAW
///   range:              DISTANCE_SENSOR that looks down, RANGEFINDER
/// Then the lower number of the sensor, where the message has one. A sample has the time in its
/// message if that is at most 2 s before and 1 s after `latest_ns`, and `latest_ns` otherwise; that
/// of a GPS may be older. The axes are the body's (forward-right-down), accelerations are specific
/// forces, in MAVLink and here. An indicated airspeed and its pressure follow from each other in
/// air of 1.225 kg/m^3.
///
/// Left out: fields that are not updated (HIGHRES_IMU), magnetic fields of zero (no magnetometer),
/// values outside of what such sensors measure. A GPS without a fix gives a sample without one.
/// @return empty for other messages, and if no sample is left
[[nodiscard]] std::optional<MessageSamples> sensor_samples_of(const Frame& frame,
                                                              const SensorContext& context);

}  // namespace overfly::flight::mavlink
