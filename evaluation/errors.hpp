// Errors of aligned poses. Private to evaluation.
#pragma once

#include <vector>

#include "evaluation/evaluation.hpp"

namespace overfly::evaluation {

/// Root mean square, mean, median (of an even number: mean of the middle two) and maximum.
/// @pre !errors.empty()
[[nodiscard]] ErrorStatistics statistics_of(std::vector<double> errors);

[[nodiscard]] double rms(const std::vector<double>& values);

/// Norm of the wrapped differences of roll, pitch and yaw of two bodies [rad]. Unlike the geodesic
/// angle it can exceed pi: (170, 90, -170) deg apart are 256 deg.
[[nodiscard]] double euler_norm_rad(const Eigen::Quaterniond& R_world_body_a,
                                    const Eigen::Quaterniond& R_world_body_b);

/// Fills position, rotation and relative errors of a score whose S_world_vo is set; rotation errors
/// only where the alignment is not degenerate (relative ones do not depend on it).
/// @pre !matches.empty()
void add_errors(const std::vector<MatchedPose>& matches,
                const Options& options,
                AlignmentScore* score);

/// @param T_world_camera_estimate  aligned, one for each match
[[nodiscard]] std::vector<RelativeError> relative_errors(
    const std::vector<MatchedPose>& matches,
    const std::vector<Pose>& T_world_camera_estimate,
    const std::vector<double>& lengths_m);

}  // namespace overfly::evaluation
