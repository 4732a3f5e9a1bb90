// Updates on SE(3), shared by all optimisers.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/motion/pose.hpp"

namespace overfly::odometry {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Matrix23d = Eigen::Matrix<double, 2, 3>;
using Matrix26d = Eigen::Matrix<double, 2, 6>;

/// The cross product matrix [v]x.
[[nodiscard]] inline Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// Rotation from the rotation vector phi (axis times angle [rad]).
[[nodiscard]] inline Eigen::Quaterniond exp_so3(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  if (angle < 1e-12) {
    return Eigen::Quaterniond(1.0, 0.5 * phi.x(), 0.5 * phi.y(), 0.5 * phi.z()).normalized();
  }
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, phi / angle));
}

/// The rotation vector of a unit quaternion, of length in [0, pi].
[[nodiscard]] inline Eigen::Vector3d log_so3(const Eigen::Quaterniond& rotation) {
  const Eigen::AngleAxisd angle_axis(rotation);
  return angle_axis.angle() * angle_axis.axis();
}

/// Applies the left update xi = (rho, phi) to T_camera_vo: X' = exp(phi) X + rho.
[[nodiscard]] inline Pose moved(const Pose& T_camera_vo, const Vector6d& xi) {
  const Eigen::Quaterniond R_step = exp_so3(xi.tail<3>());
  return {(R_step * T_camera_vo.rotation).normalized(),
          R_step * T_camera_vo.translation + xi.head<3>()};
}

/// Derivative of the pixel with respect to the point in the camera frame.
[[nodiscard]] inline Matrix23d projection_jacobian(double fx, double fy, const Eigen::Vector3d& p) {
  const double inverse_z = 1.0 / p.z();
  Matrix23d J;
  J << fx * inverse_z, 0.0, -fx * p.x() * inverse_z * inverse_z, 0.0, fy * inverse_z,
      -fy * p.y() * inverse_z * inverse_z;
  return J;
}

/// Derivative of the pixel with respect to the update xi of `moved` at xi = 0.
[[nodiscard]] inline Matrix26d pose_jacobian(const Matrix23d& J_projection,
                                             const Eigen::Vector3d& p_camera) {
  Matrix26d J;
  J.leftCols<3>() = J_projection;
  J.rightCols<3>() = -J_projection * skew(p_camera);
  return J;
}

}  // namespace overfly::odometry
