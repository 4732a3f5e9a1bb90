// Metrics as a table for people.
#pragma once

#include <string>

#include "evaluation/evaluation.hpp"
#include "server/scoring/run_metrics.hpp"

namespace overfly::app {

/// One line for each estimator of a run: outcome, coverage, errors by `mode`.
[[nodiscard]] std::string score_table(const server::RunMetrics& metrics,
                                      evaluation::AlignmentMode mode);

/// "coverage 45.6 %"
[[nodiscard]] std::string coverage_text(const evaluation::Score& score);
/// "LOST at 12.3 s, after 500 m; found its map again at 15.1 s, coverage 45.6 %"
[[nodiscard]] std::string outcome_line(const evaluation::Score& score);

/// One line for each alignment of an estimate: mode, scale, position and rotation error.
[[nodiscard]] std::string alignment_table(const evaluation::Score& score);

/// Warnings about the images that affect the scores, one a line: imagery that limits the result,
/// late tiles, faults. Empty if there are none.
[[nodiscard]] std::string camera_notes(const server::RunMetrics& metrics);

/// "none", "origin", ...: values of the options that choose an alignment.
[[nodiscard]] std::vector<std::string> alignment_mode_names();

}  // namespace overfly::app
