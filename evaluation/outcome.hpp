// How the run of an estimator went. Private to evaluation.
#pragma once

#include <vector>

#include "evaluation/evaluation.hpp"

namespace overfly::evaluation {

/// A frame of the flight, and what the estimator said of it.
struct FlownFrame {
  EstimateSample sample;  ///< of a frame that it never got: frame, time, and the map before
  bool given = true;      ///< false: dropped, late, lost on its way, or never given
};

/// Every frame of the flight, in order: Options::flight, and the samples of the track.
[[nodiscard]] std::vector<FlownFrame> flown_frames(const EstimateTrack& estimate,
                                                   const Options& options);

/// Fills outcome, its time, resets, coverage and counts.
/// @param matches  of the longest map; may be empty
void add_outcome(const std::vector<FlownFrame>& flown,
                 const std::vector<MatchedPose>& matches,
                 Score* score);

/// Time at which the scale against the truth, over windows of 10 s, has changed by more than a
/// factor of two between any two windows so far; empty if it never does. Path lengths are summed
/// over steps of a second, so that jitter from frame to frame does not count as way.
[[nodiscard]] std::optional<double> divergence_time_s(const std::vector<MatchedPose>& matches);

}  // namespace overfly::evaluation
