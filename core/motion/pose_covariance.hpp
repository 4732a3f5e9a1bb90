// How uncertain an estimated pose is, as its estimator states it.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/motion/pose.hpp"
#include "core/result.hpp"

namespace overfly {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Covariance of the error of a pose T_vo_camera.
///
/// Order: position x, y, z of the camera, then a small rotation about the fixed axes x, y, z of the
/// frame `vo` (not of the camera). With the error (d, theta), the true pose has the position p + d
/// and the rotation exp(theta) * R_vo_camera. This is the order and the meaning of ROS's
/// PoseWithCovariance.
/// Units: vo^2 of the positions, rad^2 of the rotations, vo rad of both together.
struct PoseCovariance {
  Matrix6d matrix = Matrix6d::Zero();  ///< symmetric, positive semi-definite
  bool has_rotation = true;            ///< false: only the position is known, the rest is 0
};

/// Null if an estimator states none. Shared because most poses have none.
using PoseCovariancePtr = std::shared_ptr<const PoseCovariance>;

/// Values of a covariance row by row: 9 of the position or 36 of the whole pose. The result is
/// exactly symmetric. Rotations whose values are all 0 are not known.
/// Errors: kInvalidArgument for another number of values, one that is not finite or beyond 1e24, a
/// matrix that is not symmetric (to 1e-6 of the standard deviations' product) or not positive
/// semi-definite (to 1e-6, as a matrix of correlations).
[[nodiscard]] Result<PoseCovariance> pose_covariance_from(std::span<const double> row_major);

/// True if all values are 0: what messages contain whose sender does not know its covariance.
[[nodiscard]] bool is_unstated(std::span<const double> row_major);

/// The upper triangle row by row: 21 values, or 6 if only the position is known.
[[nodiscard]] std::vector<double> upper_triangle(const PoseCovariance& covariance);
/// The inverse, for pose_covariance_from: all values row by row. Another number of values is
/// returned as it is.
[[nodiscard]] std::vector<double> row_major_from_upper(const std::vector<double>& upper);

/// Errors of the pose in another frame: positions are rotated and scaled, rotations are rotated.
[[nodiscard]] Matrix6d in_target(const Similarity& S_target_vo, const Matrix6d& covariance);

/// Covariance of T_b_a, with rotations about the fixed axes of b, from that of T_a_b with rotations
/// about those of a; to first order.
[[nodiscard]] Matrix6d inverted_covariance(const Pose& T_a_b, const Matrix6d& covariance);

/// The error e in standard deviations, squared: e^T P^-1 e. Empty if P is singular: a direction has
/// (relative to the standard deviations) a variance below 1e-10.
[[nodiscard]] std::optional<double> squared_deviation(const Eigen::Vector3d& error,
                                                      const Eigen::Matrix3d& covariance);
[[nodiscard]] std::optional<double> squared_deviation(const Vector6d& error,
                                                      const Matrix6d& covariance);

}  // namespace overfly
