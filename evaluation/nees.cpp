// The consistency of matched poses with their covariances, by one alignment.
#include <Eigen/Geometry>

#include "evaluation/errors.hpp"

namespace overfly::evaluation {
namespace {

/// The rotation theta about the axes of the world with R_true = exp(theta) * R_estimate [rad].
Eigen::Vector3d rotation_error_rad(const Eigen::Quaterniond& R_true,
                                   const Eigen::Quaterniond& R_estimate) {
  const Eigen::AngleAxisd turn(R_true * R_estimate.conjugate());
  return turn.axis() * wrap_pi(turn.angle());
}

/// The alignments that put the first pose onto the truth: its error says nothing.
bool holds_first_pose(AlignmentMode mode) {
  return mode == AlignmentMode::kOrigin || mode == AlignmentMode::kInitScale ||
         mode == AlignmentMode::kOriginSim3;
}

std::optional<double> position_deviation(const Vector6d& error, const Matrix6d& P) {
  return squared_deviation(Eigen::Vector3d(error.head<3>()),
                           Eigen::Matrix3d(P.topLeftCorner<3, 3>()));
}

std::optional<double> rotation_deviation(const Vector6d& error, const Matrix6d& P) {
  return squared_deviation(Eigen::Vector3d(error.tail<3>()),
                           Eigen::Matrix3d(P.bottomRightCorner<3, 3>()));
}

std::optional<Nees> nees_or_none(const std::vector<double>& squared, int degrees) {
  return squared.empty() ? std::nullopt : std::optional<Nees>(nees_of(squared, degrees));
}

}  // namespace

std::optional<Consistency> consistency_of(const std::vector<MatchedPose>& matches,
                                          const AlignmentScore& score) {
  Consistency result;
  std::vector<double> positions, rotations, poses;
  bool any = false;
  const std::size_t first = holds_first_pose(score.mode) ? 1 : 0;
  for (std::size_t i = first; i < matches.size(); ++i) {
    const MatchedPose& match = matches[i];
    if (match.covariance == nullptr) continue;
    any = true;
    const Matrix6d P = in_target(score.S_world_vo, match.covariance->matrix);
    const Pose estimate = score.S_world_vo * match.T_vo_camera;
    Vector6d error;
    error << match.T_world_camera.translation - estimate.translation,
        rotation_error_rad(match.T_world_camera.rotation, estimate.rotation);
    if (const auto squared = position_deviation(error, P)) {
      positions.push_back(*squared);
    } else {
      ++result.singular;
    }
    if (!match.covariance->has_rotation || score.degenerate) continue;
    if (const auto squared = rotation_deviation(error, P)) {
      rotations.push_back(*squared);
    }
    if (const auto squared = squared_deviation(error, P)) poses.push_back(*squared);
  }
  if (!any) return std::nullopt;
  result.position = nees_or_none(positions, 3);
  result.rotation = nees_or_none(rotations, 3);
  result.pose = nees_or_none(poses, 6);
  return result;
}

}  // namespace overfly::evaluation
