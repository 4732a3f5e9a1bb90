// Determines the outcome of an estimator's run. Private to evaluation.
#pragma once

#include <vector>

#include "evaluation/evaluation.hpp"

namespace overfly::evaluation {

/// A frame of the flight and the estimator's output for it.
struct FlownFrame {
  EstimateSample sample;  ///< if not received: frame, time and the previous map
  /// Time of the frame in the flight, which a fault of the camera's clock does not change; the
  /// sample's stamp if Options::flight does not contain the frame.
  std::int64_t t_ns = 0;
  bool given = true;  ///< false: dropped, late, lost in transport or never sent
};

/// Every frame of the flight, in order: Options::flight and the samples of the track.
[[nodiscard]] std::vector<FlownFrame> flown_frames(const EstimateTrack& estimate,
                                                   const Options& options);

/// Sets outcome, outcome time, relocalisations, resets, coverage and counts.
/// @param matches  of the longest map; may be empty
void add_outcome(const std::vector<FlownFrame>& flown,
                 const std::vector<MatchedPose>& matches,
                 Score* score);

/// The stamp at which the estimate's scale relative to the truth has changed by more than a factor
/// of two between any two windows of 10 s; empty if it never does. Path lengths are summed over
/// steps of one second, so that jitter between frames does not add to the path.
[[nodiscard]] std::optional<std::int64_t> divergence_time_ns(
    const std::vector<MatchedPose>& matches);

}  // namespace overfly::evaluation
