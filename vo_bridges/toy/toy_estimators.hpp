// Estimators that receive the truth, to test the stages after an estimator: their scores have a
// closed form. They are always marked as test estimators.
#pragma once

#include <memory>

#include "core/trajectory.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly {

/// Truth in the estimator's frame: origin and rotation of the first pose, lengths times `scale`.
struct ToyParameters {
  double scale = 0.37;  ///< vo units per metre, > 0
  double drift = 0.0;   ///< position error per path length: 0.01 = 1 %, in (-1, 1]
  /// True depth of the ground along the optical axis at each frame [m]; 0 = report none.
  double scene_depth_m = 0.0;
};

/// Returns the truth ("perfect").
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_perfect_estimator(
    const Trajectory& T_world_camera, const ToyParameters& parameters);

/// Returns the truth with every step along the path lengthened by `drift` ("drifting"): after a
/// path of length s the position error is drift * (displacement from the start).
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_drifting_estimator(
    const Trajectory& T_world_camera, const ToyParameters& parameters);

}  // namespace overfly
