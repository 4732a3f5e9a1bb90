// Measurements of the earth's magnetic field in body axes.
#pragma once

#include "core/motion/truth_source.hpp"
#include "core/sensors/sensor_samples.hpp"
#include "flight/normal_noise.hpp"
#include "flight/sensors/sensor_models.hpp"
#include "flight/sensors/sensor_place.hpp"

namespace overfly::flight {

/// Sampled at its rate: the World Magnetic Model's field with white noise and a constant bias.
class Magnetometer {
 public:
  Magnetometer(const MagnetometerModel& model, std::uint64_t seed);
  [[nodiscard]] MagnetometerSample measure(const AircraftState& state, const SensorPlace& place);

 private:
  MagnetometerModel model_;
  NormalNoise noise_;
  Eigen::Vector3d bias_ut_;
};

}  // namespace overfly::flight
