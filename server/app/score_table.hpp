// Metrics as a table for people.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace overfly::app {

/// One line for each estimator of a metrics document: outcome, coverage, errors by `mode`.
[[nodiscard]] std::string score_table(const nlohmann::json& metrics, const std::string& mode);

/// "coverage 45.6 %", from an estimator's score.
[[nodiscard]] std::string coverage_text(const nlohmann::json& score);
/// "LOST at 12.3 s, coverage 45.6 %", from an estimator's score.
[[nodiscard]] std::string outcome_line(const nlohmann::json& score);

/// One line for each alignment of an estimate: mode, scale, position and rotation error.
[[nodiscard]] std::string alignment_table(const nlohmann::json& alignments,
                                          const nlohmann::json& unavailable);

/// Warnings about the images that affect the scores, one a line: imagery that limits the result,
/// late tiles, faults. Empty if there are none.
[[nodiscard]] std::string camera_notes(const nlohmann::json& metrics);

}  // namespace overfly::app
