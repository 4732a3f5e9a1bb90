// Which truth belongs to a frame. Private to evaluation.
#pragma once

#include <optional>

#include "evaluation/evaluation.hpp"

namespace overfly::evaluation {

/// Truth of one frame, and the stamp that it has in the score.
struct FrameTruth {
  std::int64_t t_ns = 0;
  Pose T_world_camera;
};

/// Empty where the truth does not cover the frame. With kNearest several frames may get one pose.
[[nodiscard]] std::optional<FrameTruth> truth_of(const Trajectory& T_world_camera_truth,
                                                 const EstimateSample& sample,
                                                 const Options& options);

/// The map with the most tracked frames, the first of equals; empty if none is tracked.
[[nodiscard]] std::optional<int> longest_map(const EstimateTrack& estimate);

}  // namespace overfly::evaluation
