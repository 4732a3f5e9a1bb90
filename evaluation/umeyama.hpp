// Least-squares similarity transforms between point sets. Private to evaluation.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "evaluation/evaluation.hpp"

namespace overfly::evaluation {

/// A path counts as straight if the second singular value is below this fraction of the first.
/// Positions then do not determine the rotation about the path. The limit applies to the covariance
/// of truth and estimate (39) and to the truth's own covariance, both about the centre of the fit.
/// It corresponds to a lateral spread below 3.2 % of the longitudinal one.
///
/// Derivation: position errors of size sigma across the path rotate the fit about the path by sigma
/// / s2, where s2 is the lateral standard deviation. Errors within one flight are correlated, so
/// more poses do not reduce this angle. A good odometry drifts by one percent of the length L.
/// Along an evenly sampled path s1 = L / sqrt(12), so sigma / s1 = 0.035, and at (s2 / s1)^2 = 1e-3
/// the angle is 1.1 rad: the rotation is arbitrary.
inline constexpr double kStraightRatio = 1e-3;

struct FitOptions {
  bool with_scale = false;
  /// Fix the first position instead of the mean.
  bool hold_first = false;
  /// Take the rotation about a path that is nearly straight (kStraightRatio) from the orientations.
  /// Needed if the fit is applied to poses beside the line, which that rotation moves.
  bool turn_nearly_straight = false;
};

/// Computes the S_world_vo that minimises the sum of squared position errors.
/// Method: Umeyama 1991, "Least-squares estimation of transformation parameters between two point
/// patterns", eq. 34-43, doi:10.1109/34.88573. With hold_first the same derivation applies about
/// the first point, with the translation eliminated by the constraint (Horn 1987, sec. 2).
/// Near a line (kStraightRatio) `remarks` says that the rotation about it is not determined. On an
/// exact line, and with turn_nearly_straight also near one, the rotation that best aligns the
/// orientations is used (least chordal distance; noted), with the best scale for it.
/// Errors: kInvalidArgument for fewer than two poses and for positions that do not move.
[[nodiscard]] Result<Similarity> fit_similarity(const std::vector<MatchedPose>& matches,
                                                const FitOptions& options,
                                                AlignmentRemarks* remarks);

/// Fits rotation about the vertical and translation only; scale 1.
/// Method: Zhang and Scaramuzza 2018, "A tutorial on quantitative trajectory evaluation for
/// visual(-inertial) odometry", sec. III, doi:10.1109/IROS.2018.8593941.
/// Errors: kInvalidArgument for positions that do not move horizontally.
[[nodiscard]] Result<Similarity> fit_yaw(const std::vector<MatchedPose>& matches);

}  // namespace overfly::evaluation
