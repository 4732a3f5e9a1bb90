#include "odometry/adjustment/pose_optimiser.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "odometry/geometry/lie.hpp"

namespace overfly::odometry {
namespace {

constexpr double kMinDepth = 1e-6;

/// Residual in pixels; returns false if the point is not in front.
bool residual_of(const PinholeCamera& camera,
                 const Eigen::Vector3d& p_camera,
                 const Eigen::Vector2d& pixel,
                 Eigen::Vector2d& residual) {
  if (p_camera.z() < kMinDepth) return false;
  residual = Eigen::Vector2d(camera.fx_px * p_camera.x() / p_camera.z() + camera.cx_px,
                             camera.fy_px * p_camera.y() / p_camera.z() + camera.cy_px) -
             pixel;
  return true;
}

/// Adds weight * J^T J to H. Eigen's rankUpdate gives the same bits, but copies the operands as for
/// large matrices.
void add_weighted_square(const Matrix26d& J, double weight, Matrix6d& H) {
  const Vector6d x = J.row(0);
  const Vector6d y = J.row(1);
  for (int column = 0; column < 6; ++column) {
    H.col(column) += weight * (x * x[column] + y * y[column]);
  }
}

/// One Gauss-Newton step; returns its length, or a negative number if it is undetermined.
double step(const PinholeCamera& camera,
            const std::vector<PoseObservation>& observations,
            const std::vector<std::uint8_t>& used,
            double huber,
            Pose& T_camera_vo) {
  Matrix6d H = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  const Eigen::Matrix3d R = T_camera_vo.rotation.toRotationMatrix();
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (used[i] == 0) continue;
    const PoseObservation& seen = observations[i];
    const Eigen::Vector3d p = R * seen.point_vo + T_camera_vo.translation;
    Eigen::Vector2d residual;
    if (!residual_of(camera, p, seen.pixel, residual)) continue;
    const double error = residual.norm() / seen.sigma_px;
    const double weight = (error <= huber ? 1.0 : huber / error) / (seen.sigma_px * seen.sigma_px);
    const Matrix26d J = pose_jacobian(projection_jacobian(camera.fx_px, camera.fy_px, p), p);
    add_weighted_square(J, weight, H);
    b.noalias() -= weight * (J.transpose() * residual);
  }
  const Eigen::LDLT<Matrix6d, Eigen::Lower> solver(H);
  if (solver.info() != Eigen::Success || !solver.isPositive()) return -1.0;
  const Vector6d xi = solver.solve(b);
  if (!xi.allFinite()) return -1.0;
  T_camera_vo = moved(T_camera_vo, xi);
  return xi.norm();
}

void classify(const PinholeCamera& camera,
              const std::vector<PoseObservation>& observations,
              double outlier,
              PoseFit& fit) {
  fit.inliers = 0;
  double squares = 0.0;
  const Eigen::Matrix3d R = fit.T_camera_vo.rotation.toRotationMatrix();
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const PoseObservation& seen = observations[i];
    Eigen::Vector2d residual;
    const Eigen::Vector3d p = R * seen.point_vo + fit.T_camera_vo.translation;
    const bool good = residual_of(camera, p, seen.pixel, residual) &&
                      residual.squaredNorm() < std::pow(outlier * seen.sigma_px, 2);
    fit.inlier[i] = good ? 1 : 0;
    if (!good) continue;
    ++fit.inliers;
    squares += residual.squaredNorm();
  }
  fit.rms_px = fit.inliers > 0 ? std::sqrt(squares / fit.inliers) : 0.0;
}

}  // namespace

PoseFit optimise_pose(const PinholeCamera& camera,
                      const Pose& T_camera_vo_start,
                      const std::vector<PoseObservation>& observations,
                      const PoseFitOptions& options) {
  PoseFit fit;
  fit.T_camera_vo = T_camera_vo_start;
  fit.inlier.assign(observations.size(), 1);
  for (int round = 0; round < options.rounds; ++round) {
    for (int i = 0; i < options.iterations_per_round; ++i) {
      const double length = step(camera, observations, fit.inlier, options.huber, fit.T_camera_vo);
      if (length < 1e-9) break;
    }
    classify(camera, observations, options.outlier, fit);
    if (fit.inliers < 4) break;
  }
  return fit;
}

}  // namespace overfly::odometry
