#include "flight/autopilot/parameters.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/motion/pose.hpp"
#include "core/text/number_text.hpp"
#include "flight/dynamics/modes.hpp"
#include "flight/dynamics/trim.hpp"

namespace overfly::autopilot {
namespace {

using P = Parameters;

constexpr std::array kTable{
    ParameterInfo{"AIRSPEED_CRUISE", &P::airspeed_cruise, 5.0, 80.0},
    ParameterInfo{"AIRSPEED_MAX", &P::airspeed_max, 5.0, 100.0},
    ParameterInfo{"AIRSPEED_MIN", &P::airspeed_min, 4.0, 80.0},
    ParameterInfo{"KFF_RDDRMIX", &P::kff_rddrmix, 0.0, 1.0},
    ParameterInfo{"LAND_FLARE_ALT", &P::land_flare_alt, 0.0, 30.0},
    ParameterInfo{"LAND_PITCH_DEG", &P::land_pitch_deg, -5.0, 15.0},
    ParameterInfo{"NAVL1_DAMPING", &P::navl1_damping, 0.5, 1.0},
    ParameterInfo{"NAVL1_PERIOD", &P::navl1_period, 3.0, 60.0},
    ParameterInfo{"PTCH2SRV_RMAX_DN", &P::ptch2srv_rmax_dn, 1.0, 200.0},
    ParameterInfo{"PTCH2SRV_RMAX_UP", &P::ptch2srv_rmax_up, 1.0, 200.0},
    ParameterInfo{"PTCH2SRV_TCONST", &P::ptch2srv_tconst, 0.1, 2.0},
    ParameterInfo{"PTCH_LIM_MAX_DEG", &P::ptch_lim_max_deg, 0.0, 60.0},
    ParameterInfo{"PTCH_LIM_MIN_DEG", &P::ptch_lim_min_deg, -60.0, 0.0},
    ParameterInfo{"PTCH_RATE_FF", &P::ptch_rate_ff, 0.0, 10.0},
    ParameterInfo{"PTCH_RATE_I", &P::ptch_rate_i, 0.0, 20.0},
    ParameterInfo{"PTCH_RATE_P", &P::ptch_rate_p, 0.0, 10.0},
    ParameterInfo{"RLL2SRV_RMAX", &P::rll2srv_rmax, 1.0, 200.0},
    ParameterInfo{"RLL2SRV_TCONST", &P::rll2srv_tconst, 0.1, 2.0},
    ParameterInfo{"RLL_RATE_FF", &P::rll_rate_ff, 0.0, 10.0},
    ParameterInfo{"RLL_RATE_I", &P::rll_rate_i, 0.0, 20.0},
    ParameterInfo{"RLL_RATE_P", &P::rll_rate_p, 0.0, 10.0},
    ParameterInfo{"ROLL_LIMIT_DEG", &P::roll_limit_deg, 5.0, 68.0},
    ParameterInfo{"RTL_ALTITUDE", &P::rtl_altitude, 10.0, 3000.0},
    ParameterInfo{"TECS_CLMB_MAX", &P::tecs_clmb_max, 0.1, 20.0},
    ParameterInfo{"TECS_INTEG_GAIN", &P::tecs_integ_gain, 0.0, 2.0},
    ParameterInfo{"TECS_PTCH_DAMP", &P::tecs_ptch_damp, 0.0, 2.0},
    ParameterInfo{"TECS_RLL2THR", &P::tecs_rll2thr, 0.0, 200.0},
    ParameterInfo{"TECS_SINK_MAX", &P::tecs_sink_max, 0.1, 30.0},
    ParameterInfo{"TECS_SINK_MIN", &P::tecs_sink_min, 0.05, 10.0},
    ParameterInfo{"TECS_SPDWEIGHT", &P::tecs_spdweight, 0.0, 2.0},
    ParameterInfo{"TECS_THR_DAMP", &P::tecs_thr_damp, 0.0, 2.0},
    ParameterInfo{"TECS_TIME_CONST", &P::tecs_time_const, 1.0, 20.0},
    ParameterInfo{"THR_MAX", &P::thr_max, 1.0, 100.0},
    ParameterInfo{"THR_MIN", &P::thr_min, 0.0, 99.0},
    ParameterInfo{"TKOFF_LVL_PITCH", &P::tkoff_lvl_pitch, 0.0, 30.0},
    ParameterInfo{"TRIM_THROTTLE", &P::trim_throttle, 0.0, 100.0},
    ParameterInfo{"WP_LOITER_RAD", &P::wp_loiter_rad, -10000.0, 10000.0, 1.0},
    ParameterInfo{"WP_RADIUS", &P::wp_radius, 1.0, 10000.0},
    ParameterInfo{"YAW2SRV_DAMP", &P::yaw2srv_damp, 0.0, 10.0},
    ParameterInfo{"YAW2SRV_INT", &P::yaw2srv_int, 0.0, 20.0},
};

double clamp_to(const char* name, double value) {
  const auto* info = std::find_if(kTable.begin(), kTable.end(), [name](const ParameterInfo& entry) {
    return std::string_view(entry.name) == name;
  });
  return std::clamp(value, info->minimum, info->maximum);
}

/// Damping of the roll-rate loop and of the Dutch roll.
constexpr double kLoopDamping = 0.7;
/// Bandwidth of the pitch-rate loop over that of the actuator.
constexpr double kPitchOverActuator = 0.3;
/// Integral over proportional gain of the rate loops [1/s].
constexpr double kIntegralRate = 4.0;
/// Time in which the rudder removes a sideslip [s].
constexpr double kSlipTimeS = 3.0;

void tune_roll(Parameters& p, const dynamics::LinearModel& model, const dynamics::Airframe& frame) {
  const double range = frame.aileron.range_rad();
  const double effect = model.B_lat(1, 0);
  const double forward = -model.A_lat(1, 1) / effect / range;
  // The loop of gain K around the lags a and b of actuator and airframe has the characteristic
  // polynomial a b s^2 + (a + b) s + 1 + K.
  const double a = frame.aileron.lag_s;
  const double b = -1.0 / model.A_lat(1, 1);
  const double loop_gain = (a + b) * (a + b) / (4.0 * kLoopDamping * kLoopDamping * a * b) - 1.0;
  const double gain = std::clamp(loop_gain, 0.3, 3.0) * forward;
  p.rll_rate_ff = clamp_to("RLL_RATE_FF", forward);
  p.rll_rate_p = clamp_to("RLL_RATE_P", gain);
  p.rll_rate_i = clamp_to("RLL_RATE_I", kIntegralRate * gain);
  const double rudder = std::abs(model.B_lat(2, 1)) * frame.rudder.range_rad();
  p.kff_rddrmix =
      clamp_to("KFF_RDDRMIX", -model.B_lat(2, 0) * range / rudder);  // cancels adverse yaw
}

void tune_pitch(Parameters& p,
                const dynamics::LinearModel& model,
                const dynamics::Airframe& frame) {
  // The rate that a deflection holds, without the phugoid: rows and columns of w and q.
  const Eigen::Matrix2d A = model.A_lon.block<2, 2>(1, 1);
  const Eigen::Vector2d B = model.B_lon.block<2, 1>(1, 0);
  const double rate_per_elevator = -(A.inverse() * B)(1);
  const double range = frame.elevator.range_rad();
  const double gain = kPitchOverActuator / (frame.elevator.lag_s * std::abs(B(1))) / range;
  p.ptch_rate_ff = clamp_to("PTCH_RATE_FF", std::abs(1.0 / rate_per_elevator) / range);
  p.ptch_rate_p = clamp_to("PTCH_RATE_P", gain);
  p.ptch_rate_i = clamp_to("PTCH_RATE_I", kIntegralRate * gain);
}

void tune_yaw(Parameters& p,
              const dynamics::LinearModel& model,
              const dynamics::Airframe& frame,
              double airspeed_m_s,
              double gravity_m_s2) {
  const double range = frame.rudder.range_rad();
  const double effect = std::abs(model.B_lat(2, 1));
  const auto dutch_roll = dynamics::modes(model).dutch_roll;
  if (dutch_roll && dutch_roll->damping < kLoopDamping) {
    const double missing = 2.0 * (kLoopDamping - dutch_roll->damping) * dutch_roll->frequency_rad_s;
    p.yaw2srv_damp = clamp_to("YAW2SRV_DAMP", missing / effect / range);
  }
  // A rudder r holds a sideslip (N_r / N_beta) r, which a side force of Y_beta tells.
  const double weathercock = model.A_lat(2, 0) * airspeed_m_s;
  const double side_force = std::abs(model.A_lat(0, 0)) * airspeed_m_s;
  if (weathercock > 0.0 && side_force > 0.0) {
    p.yaw2srv_int = clamp_to(
        "YAW2SRV_INT", weathercock / (effect * side_force * kSlipTimeS) * gravity_m_s2 / range);
  }
}

/// Throttle, climb and sink of the airframe's steady flights.
Status tune_energy(Parameters& p,
                   const dynamics::Airframe& frame,
                   const dynamics::Environment& environment,
                   const dynamics::Trim& level) {
  constexpr double kReserve = 0.8;  // of the best climb, and of the throttle for it
  const double v = level.airspeed_m_s;
  dynamics::TrimRequest request{.airspeed_m_s = v, .up_m = level.up_m};
  request.throttle = 1.0;
  const Result<dynamics::Trim> climb = dynamics::trim(frame, environment, request);
  if (!climb) return climb.error();
  request.throttle = 0.0;
  const Result<dynamics::Trim> glide = dynamics::trim(frame, environment, request);
  if (!glide) return glide.error();
  p.trim_throttle = clamp_to("TRIM_THROTTLE", 100.0 * level.controls.throttle);
  p.tecs_clmb_max = clamp_to("TECS_CLMB_MAX", kReserve * v * std::sin(climb->climb_rad));
  p.tecs_sink_min = clamp_to("TECS_SINK_MIN", -v * std::sin(glide->climb_rad));
  p.tecs_sink_max = clamp_to("TECS_SINK_MAX", p.tecs_sink_min);
  // Drag of a turn, from the airframe's turn at 40 deg where it can fly it.
  const double bank = rad_from_deg(40.0);
  const double load2 = 1.0 / (std::cos(bank) * std::cos(bank));
  const Result<dynamics::Trim> turn =
      dynamics::trim(frame, environment, {.airspeed_m_s = v, .bank_rad = bank, .up_m = level.up_m});
  if (turn) {
    p.tecs_rll2thr =
        clamp_to("TECS_RLL2THR",
                 100.0 * (turn->controls.throttle - level.controls.throttle) / (load2 - 1.0));
  }
  return {};
}

}  // namespace

std::span<const ParameterInfo> parameter_table() { return kTable; }

Status set_parameter(Parameters& parameters, std::string_view name, double value) {
  for (const ParameterInfo& info : kTable) {
    if (name != info.name) continue;
    if (!(value >= info.minimum && value <= info.maximum && std::abs(value) >= info.least)) {
      const std::string gap =
          info.least > 0.0 ? number_text(-info.least) + "] or [" + number_text(info.least) + ", "
                           : std::string();
      return Error{ErrorCode::kInvalidArgument,
                   std::string(name) + " = " + number_text(value) + ": must be in [" +
                       number_text(info.minimum) + ", " + gap + number_text(info.maximum) + "]"};
    }
    parameters.*info.value = value;
    return {};
  }
  return Error{ErrorCode::kInvalidArgument,
               std::string(name) + ": no parameter of the autopilot has this name"};
}

Status check(const Parameters& parameters) {
  Parameters scratch;
  for (const ParameterInfo& info : kTable) {
    if (Status status = set_parameter(scratch, info.name, parameters.*info.value); !status) {
      return status;
    }
  }
  if (parameters.airspeed_min > parameters.airspeed_cruise ||
      parameters.airspeed_cruise > parameters.airspeed_max) {
    return Error{ErrorCode::kInvalidArgument,
                 "AIRSPEED_CRUISE = " + number_text(parameters.airspeed_cruise) +
                     ": must be between AIRSPEED_MIN = " + number_text(parameters.airspeed_min) +
                     " and AIRSPEED_MAX = " + number_text(parameters.airspeed_max)};
  }
  if (parameters.thr_min >= parameters.thr_max) {
    return Error{ErrorCode::kInvalidArgument,
                 "THR_MIN = " + number_text(parameters.thr_min) +
                     ": must be below THR_MAX = " + number_text(parameters.thr_max)};
  }
  return {};
}

Result<Parameters> tuned_for(const dynamics::Airframe& airframe,
                             const dynamics::Environment& environment,
                             double airspeed_m_s,
                             double up_m) {
  const Result<dynamics::Trim> level =
      dynamics::trim(airframe, environment, {.airspeed_m_s = airspeed_m_s, .up_m = up_m});
  if (!level) return level.error();
  Parameters p;
  p.airspeed_cruise = airspeed_m_s;
  const double stall = dynamics::stall_speed_m_s(airframe, environment, up_m);
  const double turning = 1.2 * std::sqrt(std::sqrt(2.0)) * stall;  // 45 deg: load factor sqrt(2)
  p.airspeed_min =
      std::min(std::max(1.1 * stall, std::min(turning, 0.7 * airspeed_m_s)), airspeed_m_s);
  p.airspeed_max = 1.4 * airspeed_m_s;
  const dynamics::LinearModel model = dynamics::linearise(airframe, environment, *level);
  tune_roll(p, model, airframe);
  tune_pitch(p, model, airframe);
  tune_yaw(p, model, airframe, airspeed_m_s, environment.gravity_m_s2);
  if (Status status = tune_energy(p, airframe, environment, *level); !status) return status.error();
  p.wp_loiter_rad = std::max(30.0, 2.0 * airspeed_m_s * airspeed_m_s / environment.gravity_m_s2);
  p.wp_radius = std::max(10.0, 0.5 * p.wp_loiter_rad);
  p.land_flare_alt = std::clamp(0.12 * airspeed_m_s, 1.0, 5.0);
  if (Status status = check(p); !status) return status.error();
  return p;
}

}  // namespace overfly::autopilot
