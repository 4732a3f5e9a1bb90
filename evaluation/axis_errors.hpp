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
  double along_m = 0.0;   ///< horizontal, in the direction of the true motion
  double across_m = 0.0;  ///< horizontal, to the right of it
  double up_m = 0.0;
};

/// The error of each matched pose, in the order of `matches`.
///
/// The direction of the true motion is that of the horizontal displacement over half a second
/// around the pose, less at the ends of the truth and its gaps. While that is below 5 cm (hovering,
/// on the ground) the last direction applies; before the first one, that one. East stands for the
/// direction of a truth that never moves horizontally.
/// @param T_world_camera_truth  the trajectory that `matches` were associated with
[[nodiscard]] std::vector<AxisError> axis_errors(const Trajectory& T_world_camera_truth,
                                                 const std::vector<MatchedPose>& matches,
                                                 const Similarity& S_world_vo);

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
