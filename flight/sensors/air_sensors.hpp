// Measurements of the air: static pressure and airspeed.
//
// The air is that of the standard atmosphere, with the height above the ellipsoid in place of sea
// level, as the aircraft flies in it (flight/dynamics/environment.hpp).
#pragma once

#include "core/motion/truth_source.hpp"
#include "core/sensors/sensor_samples.hpp"
#include "flight/normal_noise.hpp"
#include "flight/sensors/drift.hpp"
#include "flight/sensors/sensor_models.hpp"
#include "flight/sensors/sensor_place.hpp"

namespace overfly::flight {

/// Sampled at its rate; pressure and temperature with noise and drift.
class Barometer {
 public:
  Barometer(const BarometerModel& model, std::uint64_t seed);
  [[nodiscard]] BarometerSample measure(const AircraftState& state, const SensorPlace& place);

 private:
  BarometerModel model_;
  NormalNoise noise_;
  Drift pressure_drift_;
  Drift temperature_drift_;
};

/// The dynamic pressure of the true airspeed, rho V^2 / 2, with noise and drift. Compressibility is
/// left out: 0.6 % of the pressure at 50 m/s.
class AirspeedSensor {
 public:
  AirspeedSensor(const AirspeedModel& model, std::uint64_t seed);
  [[nodiscard]] AirspeedSample measure(const AircraftState& state, const SensorPlace& place);

 private:
  AirspeedModel model_;
  NormalNoise noise_;
  Drift drift_;
};

}  // namespace overfly::flight
