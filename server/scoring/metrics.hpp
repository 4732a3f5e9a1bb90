// Derives metrics and trajectories from a run's records.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/motion/trajectory.hpp"
#include "core/result.hpp"
#include "server/record/run_records.hpp"
#include "server/scoring/run_metrics.hpp"

namespace overfly::server {

/// Scores every estimator of a run. With fewer than two frames the estimators get an outcome but no
/// errors.
[[nodiscard]] RunMetrics metrics_from(const RunRecords& records);

/// For each estimator that ended before it answered a single frame: its name and the reason.
[[nodiscard]] std::map<std::string, std::string> never_ran(const RunMetrics& metrics);

/// True if the imagery under any camera is too coarse.
[[nodiscard]] bool is_texture_limited(const RunMetrics& metrics);

/// A trajectory file of a run.
struct RunTrajectory {
  std::filesystem::path file;
  Trajectory poses;
  std::map<std::string, std::string> comments;  ///< of the TUM file
};
/// The truth of each camera (truth.tum, cameras/NAME.tum), and the scored piece of each estimate
/// (estimates/NAME.tum). Errors: kInvalidArgument if rows are not in order of time.
[[nodiscard]] Result<std::vector<RunTrajectory>> trajectories_of(
    const std::filesystem::path& folder, const RunRecords& records);
/// Errors: as trajectories_of; kIo.
[[nodiscard]] Status write_trajectories(const std::filesystem::path& folder,
                                        const RunRecords& records);
/// One of them, made from the rows of a run folder in which the file is missing: the run was
/// interrupted.
/// Errors: kNotFound while the run is not over, and for a file that no run has; as
/// read_run_records.
[[nodiscard]] Result<RunTrajectory> missing_trajectory(const std::filesystem::path& folder,
                                                       const std::filesystem::path& file);

/// Writes truth.tum, estimates/NAME.tum and metrics.json; each file appears whole or not at all.
/// @return the metrics
/// Errors: kIo.
[[nodiscard]] Result<RunMetrics> write_derived(const std::filesystem::path& folder,
                                               const RunRecords& records);

}  // namespace overfly::server
