#include "flight/sensors/air_sensors.hpp"

#include <cmath>

#include "flight/dynamics/environment.hpp"

namespace overfly::flight {
namespace {

double height_m(const AircraftState& state, const SensorPlace& place) {
  return place.frame.geodetic_from_world(state.T_world_body.translation).alt_ellipsoid_m;
}

}  // namespace

Barometer::Barometer(const BarometerModel& model, std::uint64_t seed)
    : model_(model),
      noise_(seed),
      pressure_drift_(model.drift_pa, model.drift_time_s, 1.0 / model.rate_hz),
      temperature_drift_(model.temperature_drift_k, model.drift_time_s, 1.0 / model.rate_hz) {}

BarometerSample Barometer::measure(const AircraftState& state, const SensorPlace& place) {
  const dynamics::StandardAir air = dynamics::standard_air(height_m(state, place));
  BarometerSample sample;
  sample.t_ns = state.t_ns;
  sample.pressure_pa =
      air.pressure_pa + pressure_drift_.next(noise_) + model_.noise_pa * noise_.draw();
  sample.temperature_k = air.temperature_k + temperature_drift_.next(noise_) +
                         model_.temperature_noise_k * noise_.draw();
  return sample;
}

AirspeedSensor::AirspeedSensor(const AirspeedModel& model, std::uint64_t seed)
    : model_(model),
      noise_(seed),
      drift_(model.drift_pa, model.drift_time_s, 1.0 / model.rate_hz) {}

AirspeedSample AirspeedSensor::measure(const AircraftState& state, const SensorPlace& place) {
  constexpr double kSeaLevelDensity = 1.225;
  const double density = dynamics::standard_density_kg_m3(height_m(state, place));
  const double speed = state.airspeed_m_s;
  AirspeedSample sample;
  sample.t_ns = state.t_ns;
  sample.differential_pressure_pa =
      0.5 * density * speed * speed + drift_.next(noise_) + model_.noise_pa * noise_.draw();
  const double indicated =
      std::sqrt(2.0 * std::abs(sample.differential_pressure_pa) / kSeaLevelDensity);
  sample.indicated_airspeed_m_s = std::copysign(indicated, sample.differential_pressure_pa);
  return sample;
}

}  // namespace overfly::flight
