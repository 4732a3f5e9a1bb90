#include "flight/autopilot/energy_control.hpp"

#include <algorithm>
#include <cmath>

#include "flight/dynamics/aerodynamics.hpp"

namespace overfly::autopilot {
namespace {

/// Time constants of the airspeed's filters: gusts are not followed by the throttle [s].
constexpr double kAirspeedFilterS = 0.3;
constexpr double kAccelerationFilterS = 0.5;
constexpr double kAlphaFilterS = 0.2;
}  // namespace

EnergyControl::EnergyControl(const Parameters& parameters, const dynamics::Airframe& airframe)
    : parameters_(parameters),
      alpha_per_load_m_s2_(
          2.0 * airframe.mass_kg /
          (dynamics::standard_density_kg_m3(0.0) * airframe.wing.area_m2 * airframe.lift.alpha)),
      alpha_max_rad_(kAlphaShare * dynamics::stall_point(airframe).alpha_rad) {}

void EnergyControl::start_from(double throttle, double pitch_rad) {
  throttle_integral_ = throttle - 0.01 * parameters_.trim_throttle;
  pitch_integral_rad_ = pitch_rad;
  started_ = false;
}

/// A turn needs the load factor 1 / cos(roll), and with it a larger angle of attack.
double EnergyControl::turn_alpha_rad(const FlightState& state) const {
  const double cosine = std::max(0.35, std::cos(state.attitude.roll_rad));
  const double speed = std::max(state.airspeed_m_s, parameters_.airspeed_min);
  return alpha_per_load_m_s2_ * state.gravity_m_s2 / (speed * speed) * (1.0 / cosine - 1.0);
}

EnergyControl::Output EnergyControl::update(const EnergyDemand& demand,
                                            const FlightState& state,
                                            double dt_s) {
  const Parameters& p = parameters_;
  const double g = state.gravity_m_s2;
  if (!started_) {
    airspeed_m_s_ = state.airspeed_m_s;
    alpha_rad_ = state.alpha_rad;
    acceleration_m_s2_ = 0.0;
    started_ = true;
  }
  const double change = (state.airspeed_m_s - airspeed_m_s_) / kAirspeedFilterS;
  airspeed_m_s_ += change * dt_s;
  acceleration_m_s2_ += (change - acceleration_m_s2_) * dt_s / kAccelerationFilterS;
  alpha_rad_ += (state.alpha_rad - alpha_rad_) * dt_s / kAlphaFilterS;
  const double v = std::max(airspeed_m_s_, 0.5 * p.airspeed_min);

  const double climb_m_s = state.v_world_m_s.z();
  const double wanted_climb =
      std::clamp((demand.up_m - state.position_world_m.z()) / p.tecs_time_const + demand.climb_m_s,
                 -p.tecs_sink_max,
                 p.tecs_clmb_max);
  // Power that is left for acceleration, and that which drag takes away.
  const double airspeed = std::clamp(demand.airspeed_m_s, p.airspeed_min, p.airspeed_max);
  const double wanted_acceleration = std::clamp((airspeed - v) / (0.5 * p.tecs_time_const),
                                                -0.5 * g * p.tecs_sink_min / v,
                                                0.5 * g * p.tecs_clmb_max / v);

  // Rates of energy per mass and gravity [m/s].
  const double wanted_total = wanted_climb + v * wanted_acceleration / g;
  const double total = climb_m_s + v * acceleration_m_s2_ / g;
  const double thr_min = 0.01 * p.thr_min;
  const double thr_max = 0.01 * p.thr_max;
  const double trim = 0.01 * p.trim_throttle;
  // A flight at the limit of climb has 0.8 of the power in hand (tuned_for).
  const double per_climb =
      wanted_total > 0.0 ? (1.0 - trim) / (p.tecs_clmb_max / 0.8) : trim / p.tecs_sink_min;
  const double cosine = std::max(0.35, std::cos(state.attitude.roll_rad));
  const double turn = 0.01 * p.tecs_rll2thr * (1.0 / (cosine * cosine) - 1.0);
  const double total_error = wanted_total - total;
  const double throttle = trim + turn + per_climb * wanted_total +
                          p.tecs_thr_damp * per_climb * total_error + throttle_integral_;
  if ((throttle < thr_max || total_error < 0.0) && (throttle > thr_min || total_error > 0.0)) {
    throttle_integral_ = std::clamp(
        throttle_integral_ + p.tecs_integ_gain * per_climb * total_error * dt_s, -1.0, 1.0);
  }

  // Too slow with full throttle, or about to stall, only pitch can gain airspeed.
  const bool slow = v < p.airspeed_min;
  const double weight = slow ? 2.0 : p.tecs_spdweight;
  const double high = 2.0 - weight;
  const double wanted_balance = high * wanted_climb - weight * v * wanted_acceleration / g;
  const double balance = high * climb_m_s - weight * v * acceleration_m_s2_ / g;
  const double balance_error = wanted_balance - balance;
  const double limit_down = rad_from_deg(p.ptch_lim_min_deg);
  const double limit_up =
      std::max(limit_down,
               std::min(rad_from_deg(p.ptch_lim_max_deg),
                        state.attitude.pitch_rad + alpha_max_rad_ - alpha_rad_));
  const double pitch = (wanted_balance + p.tecs_ptch_damp * balance_error) / v +
                       pitch_integral_rad_ + turn_alpha_rad(state);
  if ((pitch < limit_up || balance_error < 0.0) && (pitch > limit_down || balance_error > 0.0)) {
    pitch_integral_rad_ =
        std::clamp(pitch_integral_rad_ + p.tecs_integ_gain * balance_error / v * dt_s, -0.5, 0.5);
  }
  return {.throttle = std::clamp(throttle, thr_min, thr_max),
          .pitch_rad = std::clamp(pitch, limit_down, limit_up)};
}

}  // namespace overfly::autopilot
