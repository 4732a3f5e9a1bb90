// Least-squares similarities between point sets. Private to evaluation.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "evaluation/evaluation.hpp"

namespace overfly::evaluation {

/// A path is straight, and the rotation about it not determined by positions, where the second
/// singular value is below this part of the first, in the covariance of truth and estimate (39) or
/// in the truth's own, both about the fit's centre: lateral over longitudinal spread below 3.2 %.
///
/// An estimate whose errors reach sigma across the path turns about it by sigma / s2, with s2 the
/// lateral standard deviation: errors of one flight go together, so more poses do not lower it. One
/// percent of the length L is what a good odometry drifts; along an even path s1 = L / sqrt(12), so
/// sigma / s1 = 0.035, and at (s2 / s1)^2 = 1e-3 the angle is 1.1 rad: any angle may come out.
inline constexpr double kStraightRatio = 1e-3;

struct FitOptions {
  bool with_scale = false;
  /// Hold the first position instead of the mean.
  bool hold_first = false;
};

/// S_world_vo that minimises the sum of squared position errors.
/// Method: Umeyama 1991, "Least-squares estimation of transformation parameters between two point
/// patterns", eq. 34-43, doi:10.1109/34.88573; about the first point in place of the mean, the
/// same derivation holds with the translation eliminated by the constraint (Horn 1987, sec. 2).
/// Near a line (kStraightRatio) `remarks` says that the rotation about it is not determined; on an
/// exact one it is that which brings the orientations nearest (least chordal distance; noted).
/// Errors: kInvalidArgument for fewer than two poses and for positions that do not move.
[[nodiscard]] Result<Similarity> fit_similarity(const std::vector<MatchedPose>& matches,
                                                const FitOptions& options,
                                                AlignmentRemarks* remarks);

/// Rotation about up and translation only; scale 1.
/// Method: Zhang and Scaramuzza 2018, "A tutorial on quantitative trajectory evaluation for
/// visual(-inertial) odometry", sec. III, doi:10.1109/IROS.2018.8593941.
/// Errors: kInvalidArgument for positions that do not move horizontally.
[[nodiscard]] Result<Similarity> fit_yaw(const std::vector<MatchedPose>& matches);

}  // namespace overfly::evaluation
