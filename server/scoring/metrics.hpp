// metrics.json and the trajectories: what is derived from a run's records.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/result.hpp"
#include "evaluation/evaluation.hpp"
#include "server/record/run_records.hpp"

namespace overfly::engine {

/// One alignment as metrics.json and `overfly evaluate --json` print it.
[[nodiscard]] nlohmann::json json_from(const evaluation::AlignmentScore& score);
/// {"MODE": alignment, ...} and {"MODE": "reason", ...}
[[nodiscard]] nlohmann::json alignments_json(const evaluation::Score& score);
[[nodiscard]] nlohmann::json unavailable_json(const evaluation::Score& score);
/// Outcome, coverage and frames, with the two above.
[[nodiscard]] nlohmann::json json_from(const evaluation::Score& score);

/// Scores every estimator of a run. With fewer than two frames there is nothing to score: then the
/// estimators have an outcome only.
[[nodiscard]] nlohmann::json metrics_from(const RunRecords& records);

/// Why an estimator was gone before it answered a single frame, by its name: those that never ran.
[[nodiscard]] std::map<std::string, std::string> never_ran(const nlohmann::json& metrics);

/// True when the imagery under any camera is too coarse: metrics' `texture`, or that of one of
/// `cameras`.
[[nodiscard]] bool is_texture_limited(const nlohmann::json& metrics);

/// Writes truth.tum, estimates/NAME.tum and metrics.json, each whole.
/// @return the metrics. Errors: kIo.
[[nodiscard]] Result<nlohmann::json> write_derived(const std::filesystem::path& folder,
                                                   const RunRecords& records);

}  // namespace overfly::engine
