// Finds the samples of a log that cannot belong to a flight: erratic jumps, and steps that stay.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "flight/smoothing/samples.hpp"
#include "flight/smoothing/tracks.hpp"

namespace overfly::flight::smoothing {

/// A sudden change after which the samples go on as smoothly as before.
struct SampleStep {
  std::size_t sample = 0;  ///< the first after the step
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
};

struct Screening {
  std::vector<bool> kept;  ///< of each sample
  /// To be subtracted from each sample: positions [m], or the yaw in z [rad]. Zero in the level on
  /// which the flight has the most samples.
  std::vector<Eigen::Vector3d> shift;
  std::vector<SampleStep> steps;
};

/// Method: a Kalman filter predicts each sample. At the first one that does not fit, a second
/// filter starts with the rates of the first. If the flight returns to the prediction of the first
/// filter within 1 s, the samples in between are left out. If the second filter follows the samples
/// for 1 s and at least 5 of them, they have stepped. Shorter pieces are left out. The size of a
/// step is the least-squares difference of filters that arrive from both sides; if it is within
/// their errors, there is none. Steps that lead back to an earlier level, within the gate, do so
/// exactly; all levels are shifted to the one with the most samples.
/// @param samples  times strictly increasing, not empty
/// @return empty if no piece is long enough, or there are more than 1000
[[nodiscard]] std::optional<Screening> screen_positions(std::span<const PositionSample> samples,
                                                        const TrackLimits& limits);
[[nodiscard]] std::optional<Screening> screen_attitudes(std::span<const AttitudeSample> samples,
                                                        const TrackLimits& limits);

}  // namespace overfly::flight::smoothing
