// A smooth motion: a spline of positions and a spline of rotations.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "flight/smoothing/spline_knots.hpp"

namespace overfly::flight::smoothing {

/// Cubic B-spline in space: position, velocity and acceleration are continuous.
struct PositionSpline {
  SplineKnots knots;
  std::vector<Eigen::Vector3d> control_m;  ///< knots.control_points()

  [[nodiscard]] Eigen::Vector3d position_m(double t_s) const;
  [[nodiscard]] Eigen::Vector3d velocity_m_s(double t_s) const;
  [[nodiscard]] Eigen::Vector3d acceleration_m_s2(double t_s) const;
};

/// Cumulative cubic B-spline of rotations (Kim, Kim, Shin 1995): rotation and angular rate are
/// continuous and differentiable.
struct RotationSpline {
  SplineKnots knots;
  std::vector<Eigen::Quaterniond> control;  ///< R_ned_body, knots.control_points()

  [[nodiscard]] Eigen::Quaterniond rotation(double t_s) const;
  /// Of body relative to north-east-down, expressed in body.
  /// Method: recursion of Sommer et al. 2020 ("Efficient Derivative Computation for Cumulative
  /// B-Splines on Lie Groups").
  [[nodiscard]] Eigen::Vector3d angular_rate_rad_s(double t_s) const;
};

/// The rotation by |v| radians about v, and the shortest such vector of a rotation.
[[nodiscard]] Eigen::Quaterniond rotation_from_vector(const Eigen::Vector3d& v);
[[nodiscard]] Eigen::Vector3d vector_from_rotation(const Eigen::Quaterniond& rotation);

}  // namespace overfly::flight::smoothing
