// Errors of aligned poses. Private to evaluation.
#pragma once

#include <optional>
#include <vector>

#include "evaluation/evaluation.hpp"

namespace overfly::evaluation {

/// Root mean square, mean, median (for an even count the mean of the middle two) and maximum.
/// @pre !errors.empty()
[[nodiscard]] ErrorStatistics statistics_of(std::vector<double> errors);

[[nodiscard]] double rms(const std::vector<double>& values);

/// Norm of the wrapped differences of roll, pitch and yaw of two bodies [rad]. Unlike the geodesic
/// angle it can exceed pi: differences of (170, 90, -170) deg give 256 deg.
[[nodiscard]] double euler_norm_rad(const Eigen::Quaterniond& R_world_body_a,
                                    const Eigen::Quaterniond& R_world_body_b);

/// Computes position, rotation and relative errors of a score whose S_world_vo is set, the
/// statistics of the first two, drift and consistency. Rotation errors are set only if the
/// alignment is not degenerate; relative errors and drift do not depend on it.
/// @pre !matches.empty()
void add_errors(const std::vector<MatchedPose>& matches,
                const Options& options,
                AlignmentScore* score);

/// Area under the curve of the share of frames whose error is below a threshold, for thresholds
/// from 0 to the limit, divided by the limit: 1 if every frame has the error 0, 0 if none is below
/// the limit.
///
/// Method: the area under the accuracy-threshold curve (Xiang, Schmidt, Narayanan, Fox 2018,
/// "PoseCNN", doi:10.15607/RSS.2018.XIV.019), as its exact integral: the step of frame i at the
/// threshold e_i has the area max(0, limit - e_i), so the value is
/// (1 / frames) * sum of max(0, 1 - e_i / limit).
/// @param errors_m  of the frames that have one [m]; others, and those that are not finite, add 0
/// @param frames    all frames, >= errors_m.size(), > 0
/// @param limit_m   largest threshold, > 0
[[nodiscard]] double area_under_curve(const std::vector<double>& errors_m,
                                      int frames,
                                      double limit_m);

/// @param T_world_camera_estimate  aligned poses, one for each match
[[nodiscard]] std::vector<RelativeError> relative_errors(
    const std::vector<MatchedPose>& matches,
    const std::vector<Pose>& T_world_camera_estimate,
    const std::vector<double>& lengths_m);

/// @param T_world_camera_estimate  aligned poses, one for each match
[[nodiscard]] std::vector<FixDrift> fix_drifts(const std::vector<MatchedPose>& matches,
                                               const std::vector<Pose>& T_world_camera_estimate,
                                               const std::vector<double>& intervals_m);

/// Of a score whose mode, S_world_vo and degenerate are set. The first pose is left out where the
/// alignment makes its error 0. Empty if no pose has a covariance.
[[nodiscard]] std::optional<Consistency> consistency_of(const std::vector<MatchedPose>& matches,
                                                        const AlignmentScore& score);

}  // namespace overfly::evaluation
