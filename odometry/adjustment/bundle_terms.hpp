// Ceres terms for pose adjustment: the pose manifold and the reprojection error.
#pragma once

#include <ceres/manifold.h>
#include <ceres/sized_cost_function.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "core/camera/camera.hpp"
#include "core/motion/pose.hpp"
#include "odometry/geometry/lie.hpp"

namespace overfly::odometry {

/// A pose in the layout used with Ceres: quaternion x, y, z, w, then translation.
using PoseBlock = std::array<double, 7>;

inline Pose pose_of(const double* block) {
  return {Eigen::Quaterniond(Eigen::Map<const Eigen::Quaterniond>(block)),
          Eigen::Map<const Eigen::Vector3d>(block + 4)};
}

inline void store(const Pose& pose, double* block) {
  Eigen::Map<Eigen::Quaterniond> rotation(block);
  rotation = pose.rotation;
  Eigen::Map<Eigen::Vector3d> translation(block + 4);
  translation = pose.translation;
}

/// SE(3) with the update of `moved`. Jacobians with respect to the block hold the derivatives with
/// respect to the update in the first six columns and zeros in the seventh; the constant Jacobian
/// of this manifold selects the first six.
class PoseManifold final : public ceres::Manifold {
 public:
  [[nodiscard]] int AmbientSize() const override { return 7; }
  [[nodiscard]] int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    const Eigen::Map<const Vector6d> xi(delta);
    store(moved(pose_of(x), xi), x_plus_delta);
    return true;
  }
  bool PlusJacobian(const double* /*x*/, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>> J(jacobian);
    J.setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    const Pose to = pose_of(y);
    const Pose from = pose_of(x);
    const Eigen::Quaterniond R_step = to.rotation * from.rotation.inverse();
    Eigen::Map<Vector6d> xi(y_minus_x);
    xi << to.translation - R_step * from.translation, log_so3(R_step);
    return true;
  }
  bool MinusJacobian(const double* /*x*/, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>> J(jacobian);
    J.setIdentity();
    return true;
  }
};

/// Reprojection error of one observation [sigmas].
class Reprojection final : public ceres::SizedCostFunction<2, 7, 3> {
 public:
  /// @param sigma_px  std. deviation of the pixel's noise
  Reprojection(const PinholeCamera& camera, const Eigen::Vector2d& pixel, double sigma_px)
      : camera_(camera), pixel_(pixel), weight_(1.0 / sigma_px) {}

  bool Evaluate(double const* const* parameters,
                double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Eigen::Quaterniond> rotation(parameters[0]);
    const Eigen::Map<const Eigen::Vector3d> translation(parameters[0] + 4);
    const Eigen::Map<const Eigen::Vector3d> point(parameters[1]);
    const Eigen::Matrix3d R = rotation.toRotationMatrix();
    const Eigen::Vector3d p = R * point + translation;
    // Reject a step that puts a point behind the camera; the solver then tries a shorter one.
    if (p.z() < 1e-4) return false;
    residuals[0] = weight_ * (camera_.fx_px * p.x() / p.z() + camera_.cx_px - pixel_.x());
    residuals[1] = weight_ * (camera_.fy_px * p.y() / p.z() + camera_.cy_px - pixel_.y());
    if (jacobians == nullptr) return true;
    const Matrix23d J_projection = weight_ * projection_jacobian(camera_.fx_px, camera_.fy_px, p);
    if (jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 2, 7, Eigen::RowMajor>> J(jacobians[0]);
      J.leftCols<6>() = pose_jacobian(J_projection, p);
      J.col(6).setZero();
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>> J(jacobians[1]);
      J = J_projection * R;
    }
    return true;
  }

 private:
  const PinholeCamera& camera_;
  Eigen::Vector2d pixel_;
  double weight_;
};

}  // namespace overfly::odometry
