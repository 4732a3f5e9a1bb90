#include "flight/dynamics/aircraft.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "core/text/number_text.hpp"
#include "flight/dynamics/aerodynamics.hpp"

namespace overfly::dynamics {
namespace {

/// The fastest rate at which the airframe's rotation is damped, per density and airspeed [m^2/kg].
double fastest_damping(const Airframe& airframe) {
  const Wing& wing = airframe.wing;
  const Inertia& inertia = airframe.inertia;
  const double least = inertia.xx * inertia.zz - inertia.xz * inertia.xz;
  const double span2 = wing.span_m * wing.span_m;
  const double roll = span2 * std::abs(airframe.roll.roll_rate) * inertia.zz / least;
  const double yaw = span2 * std::abs(airframe.yaw.yaw_rate) * inertia.xx / least;
  const double pitch =
      wing.chord_m * wing.chord_m * std::abs(airframe.pitch.pitch_rate) / inertia.yy;
  return 0.25 * wing.area_m2 * std::max({roll, yaw, pitch});
}

Status check_limit(const std::string& field, double value, double limit) {
  if (value <= limit) return {};
  return Error{ErrorCode::kInvalidArgument,
               field + " = " + number_text(value) + ": must be at most " + number_text(limit)};
}

/// Also false for a motion that is not a number.
bool is_within_limits(const BodyState& state) {
  return state.v_body_m_s.norm() <= kSpeedMaxMS && state.omega_body_rad_s.norm() <= kRateMaxRadS &&
         state.position_world_m.allFinite() && state.R_world_body.coeffs().allFinite();
}

Status check_motion(const Airframe& airframe, const BodyState& state) {
  if (is_within_limits(state)) return {};
  return Error{ErrorCode::kInvalidArgument,
               "airframe " + airframe.name + ": its motion exceeds " + number_text(kSpeedMaxMS) +
                   " m/s or " + number_text(kRateMaxRadS) +
                   " rad/s: a coefficient adds energy to the motion"};
}

Status check_start(const AircraftSetup& setup, const BodyState& start) {
  const Environment& place = setup.environment;
  if (!(place.gravity_m_s2 >= 0.0 && place.gravity_m_s2 <= 100.0)) {
    return Error{ErrorCode::kInvalidArgument,
                 "gravity_m_s2 = " + number_text(place.gravity_m_s2) + ": must be in [0, 100]"};
  }
  for (const auto& [field, value, limit] :
       {std::tuple{"start.position_m", start.position_world_m.norm(), 1e7},
        {"start.attitude_norm_error", std::abs(start.R_world_body.norm() - 1.0), 1e-6},
        {"start.speed_m_s", start.v_body_m_s.norm(), 300.0},
        {"start.rate_rad_s", start.omega_body_rad_s.norm(), 100.0},
        {"wind_m_s", setup.wind_world_m_s.norm(), 100.0},
        {"alt_msl_at_origin_m", std::abs(place.alt_msl_at_origin_m), 1e5},
        {"ground_up_m", std::abs(place.ground_up_m), 1e5}}) {
    if (Status status = check_limit(field, value, limit); !status) return status;
  }
  return {};
}

}  // namespace

Result<Aircraft> Aircraft::create(const AircraftSetup& setup,
                                  const BodyState& start,
                                  const Controls& positions) {
  if (Status status = check_start(setup, start); !status) return status.error();
  return Aircraft(setup, start, limited(positions, setup.airframe));
}

Aircraft::Aircraft(const AircraftSetup& setup, const BodyState& start, const Controls& positions)
    : setup_(setup),
      body_(setup.airframe.mass_kg, setup.airframe.inertia, setup.environment.gravity_m_s2),
      damping_m2_kg_(fastest_damping(setup.airframe)),
      state_(start),
      positions_(positions),
      air_world_m_s_(setup.wind_world_m_s) {
  state_.R_world_body.normalize();
  if (setup.turbulence) {
    turbulence_.emplace(*setup.turbulence, setup.airframe.wing.span_m, setup.turbulence_seed);
    meet_gust(0.0);
  }
}

void Aircraft::meet_gust(double dt_s) {
  const Eigen::Vector3d through_air =
      state_.R_world_body * state_.v_body_m_s - setup_.wind_world_m_s;
  turbulence_->advance(
      through_air.norm(), state_.position_world_m.z() - setup_.environment.ground_up_m, dt_s);
  // Forward, right and down of the gust's axes; straight up or down counts as north.
  const double level = through_air.head<2>().norm();
  const Eigen::Vector2d forward =
      level > 0.0 ? Eigen::Vector2d(through_air.head<2>() / level) : Eigen::Vector2d(0.0, 1.0);
  const Gust& gust = turbulence_->gust();
  air_world_m_s_ = setup_.wind_world_m_s;
  air_world_m_s_.head<2>() += gust.velocity_m_s.x() * forward +
                              gust.velocity_m_s.y() * Eigen::Vector2d(forward.y(), -forward.x());
  air_world_m_s_.z() -= gust.velocity_m_s.z();
  air_rate_body_rad_s_ = gust.rate_rad_s;
}

Wrench Aircraft::wrench_at(const BodyState& state, const Controls& positions) const {
  return air_wrench(setup_.airframe,
                    state.v_body_m_s - state.R_world_body.conjugate() * air_world_m_s_,
                    state.omega_body_rad_s - air_rate_body_rad_s_,
                    positions,
                    setup_.environment.density_kg_m3(state.position_world_m.z()));
}

int Aircraft::parts_of(double dt_s) const {
  // The Runge-Kutta method is stable for rates up to 2.8 per step, and accurate well below.
  constexpr double kRatePerPart = 0.5;
  constexpr double kPartsMax = 200.0;
  const double airspeed_m_s = (state_.R_world_body * state_.v_body_m_s - air_world_m_s_).norm();
  const double density = setup_.environment.density_kg_m3(state_.position_world_m.z());
  const double rate = damping_m2_kg_ * density * airspeed_m_s + state_.omega_body_rad_s.norm();
  return static_cast<int>(std::clamp(std::ceil(dt_s * rate / kRatePerPart), 1.0, kPartsMax));
}

Status Aircraft::step(const Controls& commands, double dt_s) {
  if (turbulence_) meet_gust(dt_s);
  const int parts = parts_of(dt_s);
  const double part_s = dt_s / parts;
  for (int i = 0; i < parts; ++i) {
    const Controls middle = advance(positions_, commands, setup_.airframe, 0.5 * part_s);
    const Controls end = advance(middle, commands, setup_.airframe, 0.5 * part_s);
    const BodyState next = body_.step(state_, part_s, [&](const BodyState& state, double fraction) {
      return wrench_at(state, fraction == 0.0 ? positions_ : fraction == 1.0 ? end : middle);
    });
    if (Status status = check_motion(setup_.airframe, next); !status) return status;
    state_ = next;
    positions_ = end;
  }
  return {};
}

AirData Aircraft::air_data() const {
  const Eigen::Vector3d v = state_.v_body_m_s - state_.R_world_body.conjugate() * air_world_m_s_;
  AirData air;
  air.airspeed_m_s = v.norm();
  air.alpha_rad = std::atan2(v.z(), v.x());
  air.beta_rad = std::atan2(v.y(), std::hypot(v.x(), v.z()));
  air.density_kg_m3 = setup_.environment.density_kg_m3(state_.position_world_m.z());
  return air;
}

Eigen::Vector3d Aircraft::specific_force_body_m_s2() const {
  return wrench_at(state_, positions_).force_n / setup_.airframe.mass_kg;
}

AircraftState Aircraft::truth(std::int64_t t_ns) const {
  AircraftState truth;
  truth.t_ns = t_ns;
  truth.T_world_body = {state_.R_world_body, state_.position_world_m};
  truth.v_body_world_m_s = state_.R_world_body * state_.v_body_m_s;
  truth.omega_body_rad_s = state_.omega_body_rad_s;
  truth.airspeed_m_s = air_data().airspeed_m_s;
  return truth;
}

}  // namespace overfly::dynamics
