#include "flight/autopilot/autopilot.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "flight/dynamics/trim.hpp"

namespace overfly::autopilot {

Autopilot::Autopilot(const Parameters& parameters,
                     const dynamics::Airframe& airframe,
                     const dynamics::Environment& environment,
                     Mission mission,
                     GroundHeight ground)
    : stall_speed_(airframe, environment),
      pilot_(parameters, std::move(mission), std::move(ground)),
      energy_(parameters, airframe),
      attitude_(parameters, airframe) {}

void Autopilot::start(const FlightState& state,
                      const dynamics::Controls& positions,
                      std::size_t item) {
  pilot_.start(state, item);
  energy_.start_from(positions.throttle, state.attitude.pitch_rad);
  attitude_.start_from(positions);
}

void Autopilot::set_parameters(const Parameters& parameters, const dynamics::Airframe& airframe) {
  pilot_.set_parameters(parameters);
  energy_.set_parameters(parameters);
  attitude_.set_parameters(parameters, airframe);
}

StallSpeed::StallSpeed(const dynamics::Airframe& airframe, const dynamics::Environment& environment)
    : environment_(environment),
      at_origin_m_s_(dynamics::stall_speed_m_s(airframe, environment, 0.0)) {}

double StallSpeed::at_m_s(double up_m) const {
  return at_origin_m_s_ *
         std::sqrt(environment_.density_kg_m3(0.0) / environment_.density_kg_m3(up_m));
}

double bank_limit_rad(double stall_speed_m_s, double airspeed_m_s) {
  const double ratio = kTurnOverStall * stall_speed_m_s / std::max(airspeed_m_s, 1.0);
  return std::max(rad_from_deg(10.0), std::acos(std::min(1.0, ratio * ratio)));
}

dynamics::Controls Autopilot::update(const FlightState& state) {
  constexpr double kStepS = 1.0 / kControlRateHz;
  demand_ = pilot_.update(state, kStepS);
  const EnergyControl::Output energy = energy_.update(demand_.energy, state, kStepS);
  const double bank_max =
      bank_limit_rad(stall_speed_.at_m_s(state.position_world_m.z()), state.airspeed_m_s);
  dynamics::Controls commands = attitude_.update({std::clamp(demand_.roll_rad, -bank_max, bank_max),
                                                  demand_.pitch_rad.value_or(energy.pitch_rad)},
                                                 state,
                                                 kStepS);
  commands.throttle = demand_.throttle.value_or(energy.throttle);
  return commands;
}

}  // namespace overfly::autopilot
