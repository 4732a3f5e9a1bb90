// Derives metrics and trajectories from a run's records.
#pragma once

#include <filesystem>
#include <map>
#include <string>

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

/// Writes truth.tum, estimates/NAME.tum and metrics.json; each file appears whole or not at all.
/// @return the metrics
/// Errors: kIo.
[[nodiscard]] Result<RunMetrics> write_derived(const std::filesystem::path& folder,
                                               const RunRecords& records);

}  // namespace overfly::server
