// Samples of what messages and records say that a sensor measured.
#pragma once

#include <cstdint>

#include "core/sensors/sensor_samples.hpp"

namespace overfly {

/// Adds a sample, unless it has values outside of what such sensors measure: angular rates beyond
/// 1000 rad/s, specific forces beyond 10^4 m/s^2, pressures outside of (0, 2 * 10^5] Pa, airspeeds
/// beyond 1000 m/s, magnetic fields beyond 10^4 uT, negative ranges, and values that are not
/// finite, but for a range without an echo. A magnetic field of exactly zero stands for a sensor
/// that is not there. A temperature that is not positive becomes NaN.
/// @return whether it was added
bool add_measured(SensorSamples& to, const ImuSample& sample);
bool add_measured(SensorSamples& to, const BarometerSample& sample);
bool add_measured(SensorSamples& to, const AirspeedSample& sample);
bool add_measured(SensorSamples& to, const MagnetometerSample& sample);
bool add_measured(SensorSamples& to, const RangeSample& sample);
/// A fix at a place that is not on the earth becomes a sample without a fix; unknown velocities and
/// accuracies are NaN. @return true
bool add_measured(SensorSamples& to, const GpsSample& sample);

/// The answer of a receiver without a fix: all values are NaN.
[[nodiscard]] GpsSample gps_without_fix(std::int64_t t_ns, std::int64_t delivered_ns);
/// The airspeed of a pressure, and the pressure of an airspeed: p = rho V^2 / 2 in air of 1.225
/// kg/m^3; one has the sign of the other.
[[nodiscard]] AirspeedSample airspeed_of_pressure(std::int64_t t_ns, double pressure_pa);
[[nodiscard]] AirspeedSample airspeed_of_speed(std::int64_t t_ns, double indicated_m_s);

}  // namespace overfly
