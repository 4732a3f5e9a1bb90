// metrics.json of a run (docs/RUN_FOLDER.md), and scores in the same format.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "evaluation/evaluation.hpp"
#include "server/files/whole_file.hpp"
#include "server/scoring/run_metrics.hpp"

namespace overfly::server {

/// {"MODE": alignment, ...}
[[nodiscard]] nlohmann::json alignments_json(const evaluation::Score& score);
/// {"MODE": "reason", ...} of alignments that failed.
[[nodiscard]] nlohmann::json unavailable_json(const evaluation::Score& score);
/// Outcome, coverage and frames, with `alignments` and `unavailable`.
[[nodiscard]] nlohmann::json json_from(const evaluation::Score& score);
/// The content of metrics.json.
[[nodiscard]] nlohmann::json json_from(const RunMetrics& metrics);

/// Fields that files of earlier versions lack keep their defaults. Unknown fields, unknown
/// alignments and alignments without a transform are ignored.
/// Errors: kUnreadable naming the field.
[[nodiscard]] Result<RunMetrics> run_metrics_from(const nlohmann::json& document);
/// Errors: as read_json; kUnreadable naming file and field.
[[nodiscard]] Result<RunMetrics> read_run_metrics(const std::filesystem::path& folder,
                                                  std::uint64_t max_bytes = kMaxDocumentBytes);

}  // namespace overfly::server
