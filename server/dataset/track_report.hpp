// What is said of an estimator after a data set.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "core/result.hpp"
#include "core/trajectory_io.hpp"
#include "evaluation/evaluation.hpp"
#include "server/dataset/track_dataset.hpp"

namespace overfly::engine {

/// The truth as poses of the camera: of an EuRoC file, whose poses are the body's, by the data
/// set's mount; of KITTI's, whose poses are image_0's, by calib.txt. `notes` then says so, and what
/// the truth does not know.
[[nodiscard]] Result<Trajectory> camera_truth(const Dataset& dataset,
                                              const TrajectoryFile& truth,
                                              std::vector<std::string>& notes);

/// Scores the answers with every alignment; CRASHED where the estimator went.
/// @param init_true_depth_m  along the optical axis at the first tracked pose
[[nodiscard]] evaluation::Score score_of(const Dataset& dataset,
                                         const TrackedDataset& tracked,
                                         const Trajectory& T_world_camera,
                                         bool truth_has_times,
                                         std::optional<double> init_true_depth_m);

/// Data set, estimator, states, timing, resources; and the score where there is one.
[[nodiscard]] nlohmann::json report_json(const Dataset& dataset,
                                         const TrackedDataset& tracked,
                                         const std::optional<evaluation::Score>& score);

}  // namespace overfly::engine
