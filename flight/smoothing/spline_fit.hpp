// Fits splines to samples: least squares with a robust loss and a prior of smoothness.
#pragma once

#include <atomic>
#include <functional>
#include <span>

#include "core/result.hpp"
#include "flight/smoothing/motion_spline.hpp"
#include "flight/smoothing/noise_level.hpp"
#include "flight/smoothing/samples.hpp"

namespace overfly::flight::smoothing {

/// Called between windows with the share of them that is solved, [0, 1].
using FitProgress = std::function<void(double share)>;

/// Minimises the sum over samples of huber(|p(t) - z|^2 / sigma^2) and the integral of |jerk|^2 /
/// psd: the smoothing spline of an acceleration that wanders (Wahba 1978), on a cubic B-spline.
/// Windows of 60 s with an overlap of 6 s are solved one after another by Ceres, so memory does not
/// grow with the flight. The result is a function of the arguments.
/// @param samples  times strictly increasing, at least 2, within the knots
/// @param psd      of white jerk [m^2/s^5], > 0
/// @param cancel   checked between windows; may be null
/// @param progress may be empty
/// Errors: kCancelled; kInternal if the solver fails.
[[nodiscard]] Result<PositionSpline> fit_positions(std::span<const PositionSample> samples,
                                                   const SplineKnots& knots,
                                                   const PositionNoise& noise,
                                                   double psd,
                                                   const std::atomic<bool>* cancel,
                                                   const FitProgress& progress = {});

/// As fit_positions, for rotation vectors of the errors and the angular acceleration.
/// @param psd  of white angular acceleration [rad^2/s^3], > 0
[[nodiscard]] Result<RotationSpline> fit_rotations(std::span<const AttitudeSample> samples,
                                                   const SplineKnots& knots,
                                                   double noise_rad,
                                                   double psd,
                                                   const std::atomic<bool>* cancel,
                                                   const FitProgress& progress = {});

}  // namespace overfly::flight::smoothing
