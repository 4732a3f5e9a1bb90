// The autopilot's parameters, with ArduPlane's names where it has them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/result.hpp"
#include "flight/dynamics/airframe.hpp"
#include "flight/dynamics/environment.hpp"

namespace overfly::autopilot {

/// Units are ArduPlane's: degrees, per cent, metres, seconds. The gains of the rate loops are
/// shares of a surface's range per rad/s, at AIRSPEED_CRUISE; `tuned_for` derives them.
struct Parameters {
  double rll2srv_tconst = 0.4;  ///< roll error over demanded roll rate [s]
  double rll2srv_rmax = 75.0;   ///< limit of the demanded roll rate [deg/s]
  double rll_rate_ff = 0.0;
  double rll_rate_p = 0.0;
  double rll_rate_i = 0.0;  ///< per rad
  double ptch2srv_tconst = 0.4;
  double ptch2srv_rmax_up = 75.0;
  double ptch2srv_rmax_dn = 75.0;
  double ptch_rate_ff = 0.0;
  double ptch_rate_p = 0.0;
  double ptch_rate_i = 0.0;
  double yaw2srv_damp = 0.0;  ///< share of the rudder's range per rad/s of yaw rate
  double yaw2srv_int = 0.0;   ///< share of the rudder's range per second and g of side force
  double kff_rddrmix = 0.0;   ///< rudder per aileron, shares of their ranges
  double roll_limit_deg = 45.0;
  double ptch_lim_max_deg = 20.0;
  double ptch_lim_min_deg = -25.0;
  double navl1_period = 14.0;     ///< of the lateral response [s]
  double navl1_damping = 0.75;    ///< of the lateral response
  double tecs_time_const = 4.0;   ///< of height and airspeed [s]
  double tecs_thr_damp = 0.5;     ///< throttle per error of the energy rate
  double tecs_ptch_damp = 0.5;    ///< pitch per error of the energy balance's rate
  double tecs_integ_gain = 0.3;   ///< [1/s]
  double tecs_spdweight = 1.0;    ///< of pitch: 0 holds the height only, 2 the airspeed only
  double tecs_clmb_max = 5.0;     ///< steepest demanded climb [m/s]
  double tecs_sink_max = 5.0;     ///< steepest demanded descent [m/s]
  double tecs_sink_min = 2.0;     ///< sink rate without throttle at AIRSPEED_CRUISE [m/s]
  double tecs_rll2thr = 10.0;     ///< throttle per (1 / cos^2 roll - 1) [%]
  double trim_throttle = 45.0;    ///< level at AIRSPEED_CRUISE [%]
  double thr_min = 0.0;           ///< [%]
  double thr_max = 100.0;         ///< [%]
  double airspeed_cruise = 12.0;  ///< [m/s]
  double airspeed_min = 9.0;
  double airspeed_max = 22.0;
  double wp_radius = 30.0;        ///< a waypoint nearer than this counts as reached [m]
  double wp_loiter_rad = 60.0;    ///< of circles without a radius of their own; < 0 to the left [m]
  double rtl_altitude = 100.0;    ///< of the return, above home [m]
  double tkoff_lvl_pitch = 15.0;  ///< of the climb after the launch [deg]
  double land_flare_alt = 3.0;    ///< [m]
  double land_pitch_deg = 4.0;    ///< of the flare
};

/// One parameter as others know it.
struct ParameterInfo {
  const char* name;
  double Parameters::*value;
  double minimum;
  double maximum;
  double least = 0.0;  ///< of the absolute value
};

/// All of them, in the order of their names.
[[nodiscard]] std::span<const ParameterInfo> parameter_table();

/// Errors: kInvalidArgument naming parameter, value and limit, or the unknown name.
[[nodiscard]] Status set_parameter(Parameters& parameters, std::string_view name, double value);
/// Errors: as set_parameter, and for AIRSPEED_MIN <= AIRSPEED_CRUISE <= AIRSPEED_MAX violated.
[[nodiscard]] Status check(const Parameters& parameters);

/// Parameters for an airframe that cruises at an airspeed. Gains of the rate loops follow from its
/// linear model: the feed-forward is the surface that holds a rate, the proportional gain leaves
/// the loop slower than the actuators. Throttle, climb and sink follow from its steady flights,
/// the lowest airspeed is 1.2 times the stall speed at 45 deg of bank or the cruise less 30 %,
/// whichever is lower, and never below 1.1 times the stall speed.
/// Errors: as dynamics::trim.
[[nodiscard]] Result<Parameters> tuned_for(const dynamics::Airframe& airframe,
                                           const dynamics::Environment& environment,
                                           double airspeed_m_s,
                                           double up_m);

}  // namespace overfly::autopilot
