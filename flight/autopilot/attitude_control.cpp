#include "flight/autopilot/attitude_control.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace overfly::autopilot {
namespace {

/// Time constant of a rate against its own damping: 4 I / (rho V S l^2 |C|) [s].
double damping_time_s(double inertia, double area_m2, double length_m, double damping, double v) {
  return 4.0 * inertia /
         (dynamics::standard_density_kg_m3(0.0) * v * area_m2 * length_m * length_m *
          std::abs(damping));
}

}  // namespace

AttitudeControl::AttitudeControl(const Parameters& p, const dynamics::Airframe& frame)
    : parameters_(p),
      roll_{.forward = p.rll_rate_ff,
            .proportional = p.rll_rate_p,
            .integral = p.rll_rate_i,
            .range_rad = frame.aileron.range_rad(),
            .lowest = frame.aileron.min_rad / frame.aileron.range_rad(),
            .highest = frame.aileron.max_rad / frame.aileron.range_rad(),
            .actuator_lag_s = frame.aileron.lag_s,
            .response_s = damping_time_s(frame.inertia.xx,
                                         frame.wing.area_m2,
                                         frame.wing.span_m,
                                         frame.roll.roll_rate,
                                         p.airspeed_cruise)},
      pitch_{.forward = p.ptch_rate_ff,
             .proportional = p.ptch_rate_p,
             .integral = p.ptch_rate_i,
             .range_rad = frame.elevator.range_rad(),
             .lowest = -frame.elevator.max_rad / frame.elevator.range_rad(),
             .highest = -frame.elevator.min_rad / frame.elevator.range_rad(),
             .actuator_lag_s = frame.elevator.lag_s,
             .response_s = damping_time_s(frame.inertia.yy,
                                          frame.wing.area_m2,
                                          frame.wing.chord_m,
                                          frame.pitch.pitch_rate,
                                          p.airspeed_cruise)},
      rudder_range_rad_(frame.rudder.range_rad()) {}

void AttitudeControl::set_parameters(const Parameters& p, const dynamics::Airframe& frame) {
  const AttitudeControl before = std::exchange(*this, AttitudeControl(p, frame));
  roll_.go_on_from(before.roll_);
  pitch_.go_on_from(before.pitch_);
  yaw_held_ = before.yaw_held_;
}

void AttitudeControl::RateLoop::go_on_from(const RateLoop& before) {
  held = before.held;
  behind_actuator_rad_s = before.behind_actuator_rad_s;
  expected_rad_s = before.expected_rad_s;
}

void AttitudeControl::start_from(const dynamics::Controls& positions) {
  roll_.held = positions.aileron_rad / roll_.range_rad;
  pitch_.held = -positions.elevator_rad / pitch_.range_rad;
  yaw_held_ = positions.rudder_rad / rudder_range_rad_;
}

double AttitudeControl::RateLoop::update(double speed_ratio,
                                         double demand_rad_s,
                                         double rate_rad_s,
                                         double dt_s) {
  behind_actuator_rad_s +=
      (demand_rad_s - behind_actuator_rad_s) * std::min(1.0, dt_s / actuator_lag_s);
  expected_rad_s +=
      (behind_actuator_rad_s - expected_rad_s) * std::min(1.0, dt_s / (response_s * speed_ratio));
  const double error = expected_rad_s - rate_rad_s;
  const double square = speed_ratio * speed_ratio;
  const double direct = forward * speed_ratio * demand_rad_s + proportional * square * error;
  // A surface at its end does not integrate further.
  const double wanted = direct + held;
  if ((wanted > lowest && wanted < highest) || wanted * error < 0.0) {
    held = std::clamp(held + integral * square * error * dt_s, lowest, highest);
  }
  return std::clamp(direct + held, lowest, highest);
}

dynamics::Controls AttitudeControl::update(const AttitudeDemand& demand,
                                           const FlightState& state,
                                           double dt_s) {
  const Parameters& p = parameters_;
  const auto& [roll, pitch, yaw] = state.attitude;
  const double speed = std::max(state.airspeed_m_s, 0.5 * p.airspeed_min);
  const double ratio = std::clamp(p.airspeed_cruise / speed, 0.5, 2.0);
  // Beyond 80 deg the turn's rate has no bound.
  const double bank = std::clamp(roll, -1.4, 1.4);
  const double turn_rad_s = state.gravity_m_s2 * std::tan(bank) / speed;

  const double roll_max = rad_from_deg(p.rll2srv_rmax);
  const double roll_rate =
      std::clamp(wrap_pi(demand.roll_rad - roll) / p.rll2srv_tconst, -roll_max, roll_max);
  const double pitch_rate = std::clamp((demand.pitch_rad - pitch) / p.ptch2srv_tconst,
                                       -rad_from_deg(p.ptch2srv_rmax_dn),
                                       rad_from_deg(p.ptch2srv_rmax_up));
  // Body rates of the Z-Y-X angles' rates (Stevens, Lewis & Johnson 2016, eq. 1.4-4).
  const double p_rad_s = roll_rate - turn_rad_s * std::sin(pitch);
  const double q_rad_s =
      pitch_rate * std::cos(roll) + turn_rad_s * std::cos(pitch) * std::sin(roll);
  const double r_rad_s = turn_rad_s * std::cos(pitch) * std::cos(roll);

  const Eigen::Vector3d& omega = state.omega_body_rad_s;
  const double aileron = roll_.update(ratio, p_rad_s, omega.x(), dt_s);
  const double elevator = pitch_.update(ratio, q_rad_s, omega.y(), dt_s);
  const double side_g = state.specific_force_body_m_s2.y() / state.gravity_m_s2;
  yaw_held_ = std::clamp(yaw_held_ + p.yaw2srv_int * ratio * ratio * side_g * dt_s, -1.0, 1.0);
  const double rudder =
      yaw_held_ + p.yaw2srv_damp * ratio * (omega.z() - r_rad_s) - p.kff_rddrmix * aileron;

  return {.elevator_rad = -elevator * pitch_.range_rad,
          .aileron_rad = aileron * roll_.range_rad,
          .rudder_rad = std::clamp(rudder, -1.0, 1.0) * rudder_range_rad_};
}

}  // namespace overfly::autopilot
