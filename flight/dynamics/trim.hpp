// Steady flight: the attitude and controls at which all accelerations vanish.
#pragma once

#include <optional>

#include "core/result.hpp"
#include "flight/dynamics/actuators.hpp"
#include "flight/dynamics/airframe.hpp"
#include "flight/dynamics/environment.hpp"
#include "flight/dynamics/rigid_body.hpp"

namespace overfly::dynamics {

/// A steady flight through still air: straight, or a coordinated turn.
struct TrimRequest {
  double airspeed_m_s = 0.0;  ///< (0, 300]
  double climb_rad = 0.0;     ///< angle of the path, (-pi/3, pi/3)
  double bank_rad = 0.0;      ///< (-1.4, 1.4); right wing down and right turn > 0
  /// Of the turn, instead of the bank, |r| >= 1 m; to the right > 0.
  std::optional<double> radius_m = {};
  /// Throttle in [0, 1], instead of climb_rad: the climb or descent follows from it.
  std::optional<double> throttle = {};
  double up_m = 0.0;  ///< world; the density is that of this height
};

struct Trim {
  double airspeed_m_s = 0.0;
  double alpha_rad = 0.0;
  double beta_rad = 0.0;
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double climb_rad = 0.0;
  double turn_rate_rad_s = 0.0;  ///< of the heading, clockwise from above
  double up_m = 0.0;
  Controls controls;
  double residual = 0.0;  ///< largest acceleration left [m/s^2, rad/s^2]

  /// The state at a position of that height, with a heading (clockwise from north) and wind.
  [[nodiscard]] BodyState state(const Eigen::Vector3d& position_world_m,
                                double yaw_rad,
                                const Eigen::Vector3d& wind_world_m_s = {0.0, 0.0, 0.0}) const;
  [[nodiscard]] Eigen::Vector3d v_body_m_s() const;
  [[nodiscard]] Eigen::Vector3d omega_body_rad_s() const;
};

/// Largest residual of a trim [m/s^2, rad/s^2].
inline constexpr double kTrimResidual = 1e-9;

/// Finds the steady flight by Newton's method on the six accelerations and the side force of the
/// air, which is zero in straight and in coordinated flight.
/// Errors: kInvalidArgument for a request outside its limits, and for a flight that the airframe
/// cannot hold: it names the airspeed and the limit (stall speed, thrust, idle, a surface).
[[nodiscard]] Result<Trim> trim(const Airframe& airframe,
                                const Environment& environment,
                                const TrimRequest& request);

/// Airspeed of the largest lift coefficient: sqrt(2 n m g / (rho S C_L_max)), without thrust.
[[nodiscard]] double stall_speed_m_s(const Airframe& airframe,
                                     const Environment& environment,
                                     double up_m,
                                     double load_factor = 1.0);

}  // namespace overfly::dynamics
