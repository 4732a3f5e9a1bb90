// Estimators that receive the truth, to test the stages after an estimator: their scores have a
// closed form. They are always marked as test estimators.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "core/motion/pose.hpp"
#include "core/result.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly {

/// Truth in the estimator's frame: origin and rotation of the first pose, lengths times `scale`.
struct ToyParameters {
  double scale = 0.37;  ///< vo units per metre, > 0
  double drift = 0.0;   ///< position error per path length: 0.01 = 1 %, in (-1, 1]
  /// Depth of the ground along the optical axis to report in place of the true one [m]; 0 = report
  /// none.
  std::optional<double> scene_depth_m;
};

/// Errors: kInvalidArgument "parameters.FIELD = VALUE: must be LIMIT".
[[nodiscard]] Status check_toy_parameters(const ToyParameters& parameters);

/// The truth of one image.
struct ToyTruth {
  Pose T_world_camera;
  std::optional<double> scene_depth_m;  ///< of the ground along the optical axis
};

/// Returns the truth of the image with a time stamp; empty if there is none. Called on the thread
/// of the estimator.
using ToyTruthAt = std::function<std::optional<ToyTruth>(std::int64_t t_ns)>;

/// Returns the truth ("perfect"). Errors here and below: as check_toy_parameters.
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_perfect_estimator(
    ToyTruthAt truth, const ToyParameters& parameters);

/// Returns the truth with every step along the path lengthened by `drift` ("drifting"): after a
/// path of length s the position error is drift * (displacement from the start).
[[nodiscard]] Result<std::unique_ptr<VoPort>> create_drifting_estimator(
    ToyTruthAt truth, const ToyParameters& parameters);

}  // namespace overfly
