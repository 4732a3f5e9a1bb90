#include "evaluation/axis_errors.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/time.hpp"

namespace overfly::evaluation {
namespace {

/// Horizontal unit vector of the motion up to t; empty if it is slow or not known.
std::optional<Eigen::Vector2d> motion_direction(const Trajectory& truth,
                                                std::int64_t t_ns,
                                                const Eigen::Vector3d& p_world,
                                                double least_speed_m_s) {
  if (truth.empty()) return std::nullopt;
  const std::int64_t before_ns = std::max(t_ns - kPathWindowNs, truth.begin_ns());
  if (before_ns >= t_ns) return std::nullopt;
  const std::optional<Pose> before = truth.at(before_ns);
  if (!before) return std::nullopt;
  const Eigen::Vector2d motion_m = (p_world - before->translation).head<2>();
  const double length_m = motion_m.norm();
  if (!(length_m >= least_speed_m_s * s_from_ns(t_ns - before_ns))) return std::nullopt;
  return motion_m / length_m;
}

/// Horizontal unit vector of the nose.
Eigen::Vector2d nose_direction(const Pose& T_world_camera, const Pose& T_body_camera) {
  constexpr double kVertical = 1e-9;
  const Eigen::Quaterniond R_world_body =
      T_world_camera.rotation * T_body_camera.rotation.inverse();
  const Eigen::Vector2d nose = (R_world_body * Eigen::Vector3d::UnitX()).head<2>();
  if (!(nose.norm() > kVertical)) return Eigen::Vector2d::UnitX();
  return nose.normalized();
}

}  // namespace

AxisError axis_error(const Trajectory& T_world_camera_truth,
                     std::int64_t t_ns,
                     const Pose& T_world_camera,
                     const Eigen::Vector3d& p_world_estimated,
                     const Pose& T_body_camera,
                     double least_speed_m_s) {
  const Eigen::Vector2d along =
      motion_direction(T_world_camera_truth, t_ns, T_world_camera.translation, least_speed_m_s)
          .value_or(nose_direction(T_world_camera, T_body_camera));
  const Eigen::Vector2d right(along.y(), -along.x());
  const Eigen::Vector3d error_m = p_world_estimated - T_world_camera.translation;
  return {t_ns, error_m.head<2>().dot(along), error_m.head<2>().dot(right), error_m.z()};
}

std::vector<AxisError> axis_errors(const Trajectory& T_world_camera_truth,
                                   const std::vector<MatchedPose>& matches,
                                   const Similarity& S_world_vo,
                                   const Pose& T_body_camera,
                                   double least_speed_m_s) {
  std::vector<AxisError> errors;
  errors.reserve(matches.size());
  for (const MatchedPose& match : matches) {
    errors.push_back(axis_error(T_world_camera_truth,
                                match.t_ns,
                                match.T_world_camera,
                                S_world_vo * match.T_vo_camera.translation,
                                T_body_camera,
                                least_speed_m_s));
  }
  return errors;
}

AxisRmse rmse_of(const std::vector<AxisError>& errors) {
  if (errors.empty()) return {};
  double along = 0.0;
  double across = 0.0;
  double up = 0.0;
  for (const AxisError& error : errors) {
    along += error.along_m * error.along_m;
    across += error.across_m * error.across_m;
    up += error.up_m * error.up_m;
  }
  const auto count = static_cast<double>(errors.size());
  return {std::sqrt(along / count),
          std::sqrt(across / count),
          std::sqrt((along + across) / count),
          std::sqrt(up / count)};
}

}  // namespace overfly::evaluation
