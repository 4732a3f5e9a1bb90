// Least-squares similarities between point sets. Private to evaluation.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "evaluation/evaluation.hpp"

namespace overfly::evaluation {

struct FitOptions {
  bool with_scale = false;
  /// Hold the first position instead of the mean.
  bool hold_first = false;
};

/// S_world_vo that minimises the sum of squared position errors.
/// Method: Umeyama 1991, "Least-squares estimation of transformation parameters between two point
/// patterns", eq. 34-43, doi:10.1109/34.88573; about the first point in place of the mean, the
/// same derivation holds with the translation eliminated by the constraint (Horn 1987, sec. 2).
/// Positions on a line leave the rotation about it free: it is then that which brings the
/// orientations nearest (least chordal distance), and a note says so.
/// Errors: kInvalidArgument for fewer than two poses and for positions that do not move.
[[nodiscard]] Result<Similarity> fit_similarity(const std::vector<MatchedPose>& matches,
                                                const FitOptions& options,
                                                std::vector<std::string>* notes);

/// Rotation about up and translation only; scale 1.
/// Method: Zhang and Scaramuzza 2018, "A tutorial on quantitative trajectory evaluation for
/// visual(-inertial) odometry", sec. III, doi:10.1109/IROS.2018.8593941.
/// Errors: kInvalidArgument for positions that do not move horizontally.
[[nodiscard]] Result<Similarity> fit_yaw(const std::vector<MatchedPose>& matches);

}  // namespace overfly::evaluation
