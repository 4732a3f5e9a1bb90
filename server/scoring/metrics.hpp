// Derives metrics.json and the trajectories from a run's records.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/result.hpp"
#include "evaluation/evaluation.hpp"
#include "server/record/run_records.hpp"

namespace overfly::engine {

/// One alignment in the format of metrics.json and `overfly evaluate --json`.
[[nodiscard]] nlohmann::json json_from(const evaluation::AlignmentScore& score);
/// {"MODE": alignment, ...} and, for alignments that failed, {"MODE": "reason", ...}.
[[nodiscard]] nlohmann::json alignments_json(const evaluation::Score& score);
[[nodiscard]] nlohmann::json unavailable_json(const evaluation::Score& score);
/// Outcome, coverage and frames, with the two objects above.
[[nodiscard]] nlohmann::json json_from(const evaluation::Score& score);

/// Scores every estimator of a run. With fewer than two frames the estimators get an outcome but no
/// errors.
[[nodiscard]] nlohmann::json metrics_from(const RunRecords& records);

/// For each estimator that ended before it answered a single frame: its name and the reason.
[[nodiscard]] std::map<std::string, std::string> never_ran(const nlohmann::json& metrics);

/// True if the imagery under any camera is too coarse, as given by `texture` of the metrics or of
/// one of `cameras`.
[[nodiscard]] bool is_texture_limited(const nlohmann::json& metrics);

/// Writes truth.tum, estimates/NAME.tum and metrics.json; each file appears whole or not at all.
/// @return the metrics
/// Errors: kIo.
[[nodiscard]] Result<nlohmann::json> write_derived(const std::filesystem::path& folder,
                                                   const RunRecords& records);

}  // namespace overfly::engine
