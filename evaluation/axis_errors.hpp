// Position errors of an estimate in the axes of the true path. Pure functions of their arguments.
#pragma once

#include <cstdint>
#include <vector>

#include "core/motion/trajectory.hpp"
#include "evaluation/evaluation.hpp"

namespace overfly::evaluation {

/// Estimated minus true position. The sum of the three squares is the square of the position error.
struct AxisError {
  std::int64_t t_ns = 0;
  double along_m = 0.0;   ///< horizontal, in the direction of the path
  double across_m = 0.0;  ///< horizontal, to the right of it
  double up_m = 0.0;
};

/// The time over which the direction of the path is measured.
inline constexpr std::int64_t kPathWindowNs = 100'000'000;

/// Below this the motion gives no direction.
inline constexpr double kLeastSpeed_m_s = 1.0;

/// The error of one estimated position in the axes of the true path.
///
/// The direction of the path is that of the horizontal displacement of the camera over the last
/// 0.1 s, or since the beginning of the truth. While this displacement is slower than
/// least_speed_m_s (hovering, on the ground), at the first pose, and where the truth is unknown 0.1
/// s earlier, it is the horizontal direction of the aircraft's nose; east, if the nose points
/// straight up or down. The direction needs nothing later than `t_ns`, so a value that is computed
/// during a flight equals the one that is computed after it.
/// @param T_world_camera_truth  the poses from t_ns - kPathWindowNs on, and the one before them
/// @param T_world_camera        true pose at `t_ns`
/// @param p_world_estimated     estimated position of the camera [m]
/// @param T_body_camera         mount of the camera
[[nodiscard]] AxisError axis_error(const Trajectory& T_world_camera_truth,
                                   std::int64_t t_ns,
                                   const Pose& T_world_camera,
                                   const Eigen::Vector3d& p_world_estimated,
                                   const Pose& T_body_camera,
                                   double least_speed_m_s = kLeastSpeed_m_s);

/// axis_error() of each matched pose, in the order of `matches`.
/// @param T_world_camera_truth  the trajectory that `matches` were associated with
[[nodiscard]] std::vector<AxisError> axis_errors(const Trajectory& T_world_camera_truth,
                                                 const std::vector<MatchedPose>& matches,
                                                 const Similarity& S_world_vo,
                                                 const Pose& T_body_camera,
                                                 double least_speed_m_s = kLeastSpeed_m_s);

/// Root mean squares over all poses. total^2 = horizontal^2 + vertical^2 and
/// horizontal^2 = along^2 + across^2, where total is AlignmentScore::position_m.rmse.
struct AxisRmse {
  double along_m = 0.0;
  double across_m = 0.0;
  double horizontal_m = 0.0;
  double vertical_m = 0.0;
};

/// Zero without errors.
[[nodiscard]] AxisRmse rmse_of(const std::vector<AxisError>& errors);

}  // namespace overfly::evaluation
