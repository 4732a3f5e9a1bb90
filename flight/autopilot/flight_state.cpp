#include "flight/autopilot/flight_state.hpp"

namespace overfly::autopilot {

FlightState flight_state(const dynamics::Aircraft& aircraft) {
  const dynamics::BodyState& state = aircraft.state();
  const dynamics::AirData air = aircraft.air_data();
  return {.position_world_m = state.position_world_m,
          .v_world_m_s = state.R_world_body * state.v_body_m_s,
          .attitude = attitude_from(state.R_world_body),
          .omega_body_rad_s = state.omega_body_rad_s,
          .specific_force_body_m_s2 = aircraft.specific_force_body_m_s2(),
          .airspeed_m_s = air.airspeed_m_s,
          .alpha_rad = air.alpha_rad,
          .gravity_m_s2 = aircraft.environment().gravity_m_s2};
}

}  // namespace overfly::autopilot
