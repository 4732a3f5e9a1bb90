#include "flight/sensors/magnetometer.hpp"

namespace overfly::flight {
namespace {

Eigen::Vector3d three_numbers(NormalNoise& noise) {
  Eigen::Vector3d numbers;
  for (double& number : numbers) number = noise.draw();
  return numbers;
}

}  // namespace

Magnetometer::Magnetometer(const MagnetometerModel& model, std::uint64_t seed)
    : model_(model), noise_(seed), bias_ut_(model.bias_ut * three_numbers(noise_)) {}

MagnetometerSample Magnetometer::measure(const AircraftState& state, const SensorPlace& place) {
  const Geodetic at = place.frame.geodetic_from_world(state.T_world_body.translation);
  const Eigen::Vector3d ned_ut = place.magnetic_field->ned_ut(at);
  const Eigen::Vector3d enu_ut(ned_ut.y(), ned_ut.x(), -ned_ut.z());
  const Eigen::Vector3d world_ut = place.frame.R_world_enu_at(at) * enu_ut;
  return {state.t_ns,
          state.T_world_body.rotation.conjugate() * world_ut + bias_ut_ +
              model_.noise_ut * three_numbers(noise_)};
}

}  // namespace overfly::flight
