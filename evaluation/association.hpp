// Associates frames with truth poses. Private to evaluation.
#pragma once

#include <optional>

#include "evaluation/evaluation.hpp"

namespace overfly::evaluation {

/// Truth of one frame and the stamp used in the score.
struct FrameTruth {
  std::int64_t t_ns = 0;
  Pose T_world_camera;
};

/// Empty if the truth does not cover the frame. With kNearest several frames may get the same pose.
[[nodiscard]] std::optional<FrameTruth> truth_of(const Trajectory& T_world_camera_truth,
                                                 const EstimateSample& sample,
                                                 const Options& options);

/// The map with the most tracked frames, the first on a tie; empty if no frame is tracked.
[[nodiscard]] std::optional<int> longest_map(const EstimateTrack& estimate);

}  // namespace overfly::evaluation
