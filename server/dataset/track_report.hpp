// The report on an estimator after a data set.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "core/result.hpp"
#include "core/trajectory_io.hpp"
#include "evaluation/evaluation.hpp"
#include "server/dataset/track_dataset.hpp"

namespace overfly::engine {

/// Converts the truth to camera poses. EuRoC truth holds body poses and is converted by the data
/// set's mount; KITTI truth holds poses of image_0 and is converted by calib.txt. `notes` then
/// lists the conversion and what the truth does not contain.
[[nodiscard]] Result<Trajectory> camera_truth(const Dataset& dataset,
                                              const TrajectoryFile& truth,
                                              std::vector<std::string>& notes);

/// Scores the answers with every alignment; CRASHED if the estimator crashed.
/// @param init_true_depth_m  true depth along the optical axis at the first tracked pose
[[nodiscard]] evaluation::Score score_of(const Dataset& dataset,
                                         const TrackedDataset& tracked,
                                         const Trajectory& T_world_camera,
                                         bool truth_has_times,
                                         std::optional<double> init_true_depth_m);

/// Data set, estimator, states, timing and resources; the score if there is one.
[[nodiscard]] nlohmann::json report_json(const Dataset& dataset,
                                         const TrackedDataset& tracked,
                                         const std::optional<evaluation::Score>& score);

}  // namespace overfly::engine
