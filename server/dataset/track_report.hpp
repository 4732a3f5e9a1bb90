// The report on an estimator after a data set.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/trajectory_io.hpp"
#include "core/result.hpp"
#include "evaluation/evaluation.hpp"
#include "server/dataset/track_dataset.hpp"

namespace overfly::server {

/// Converts the truth to camera poses. EuRoC truth holds body poses and is converted by the data
/// set's mount; KITTI truth holds poses of image_0 and is converted by calib.txt. Long steps become
/// gaps (evaluation/long_steps.hpp). `notes` then lists the conversion and what the truth does not
/// contain.
[[nodiscard]] Result<Trajectory> camera_truth(const Dataset& dataset,
                                              const TrajectoryFile& truth,
                                              std::vector<std::string>& notes);

/// Scores the answers with every alignment; CRASHED or TIMEOUT if the estimator ended.
/// @param init_true_depth_m  true depth along the optical axis at the first tracked pose
[[nodiscard]] evaluation::Score score_of(const Dataset& dataset,
                                         const TrackedDataset& tracked,
                                         const Trajectory& T_world_camera,
                                         bool truth_has_times,
                                         std::optional<double> init_true_depth_m);

/// Figures about an estimator's answers to a data set.
struct TrackFigures {
  int initialising_frames = 0;
  int tracked_frames = 0;
  int lost_frames = 0;
  int maps = 0;  ///< in which it tracked
  /// From the first image to the first tracked one; empty if no image was tracked.
  std::optional<double> initialised_after_s;
  std::optional<std::string> crash;  ///< why the estimator ended
  bool hung = false;                 ///< with `crash`: it did not answer
  double cpu_percent = 0.0;          ///< of one processor while it tracked
  std::string measured_process;      ///< whose resources were measured, for people
};
[[nodiscard]] TrackFigures figures_of(const TrackedDataset& tracked);

/// Data set, estimator, states, timing and resources; the score if there is one.
[[nodiscard]] nlohmann::json report_json(const Dataset& dataset,
                                         const TrackedDataset& tracked,
                                         const std::optional<evaluation::Score>& score);

}  // namespace overfly::server
