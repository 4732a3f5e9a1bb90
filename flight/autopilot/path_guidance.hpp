// Lateral guidance along lines and circles over the ground.
#pragma once

#include <Eigen/Core>

#include "flight/autopilot/parameters.hpp"

namespace overfly::autopilot {

/// Acceleration to the right of the ground velocity [m/s^2]. Positions and velocities are east and
/// north in the world frame.
///
/// Lines: S. Park, J. Deyst, J. How, "A New Nonlinear Guidance Logic for Trajectory Tracking",
/// AIAA 2004-4900, eq. 1 with the gain 4 zeta^2 in place of 2: a = 4 zeta^2 V^2 / L1 sin(eta),
/// where eta is the angle from the velocity to the point on the line L1 = zeta P V / pi ahead.
/// Small deviations then decay with the period P (NAVL1_PERIOD) and the damping zeta
/// (NAVL1_DAMPING). Circles: the centripetal acceleration V^2 / r, and a second-order law of the
/// same period and damping on the radial error; from afar, the line along a tangent.
class PathGuidance {
 public:
  explicit PathGuidance(const Parameters& parameters);
  void set_parameters(const Parameters& parameters);

  [[nodiscard]] double along_line(const Eigen::Vector2d& from_m,
                                  const Eigen::Vector2d& to_m,
                                  const Eigen::Vector2d& position_m,
                                  const Eigen::Vector2d& velocity_m_s);
  /// @param radius_m  > 0 clockwise (to the right), < 0 counterclockwise; |radius_m| >= 1
  [[nodiscard]] double around_circle(const Eigen::Vector2d& centre_m,
                                     double radius_m,
                                     const Eigen::Vector2d& position_m,
                                     const Eigen::Vector2d& velocity_m_s);

  /// The look-ahead distance at a ground speed [m].
  [[nodiscard]] double lead_m(double speed_m_s) const;

 private:
  [[nodiscard]] double towards(const Eigen::Vector2d& direction,
                               const Eigen::Vector2d& velocity_m_s);

  double period_s_;
  double damping_;
  double last_angle_rad_ = 0.0;  // decides the side of a turn by about 180 deg
};

}  // namespace overfly::autopilot
