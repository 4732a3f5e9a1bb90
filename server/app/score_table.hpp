// Metrics as a table for people.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace overfly::app {

/// One line for each estimator of a metrics document: outcome, coverage, errors by `mode`.
[[nodiscard]] std::string score_table(const nlohmann::json& metrics, const std::string& mode);

/// "coverage 45.6 %" of an estimator's score.
[[nodiscard]] std::string coverage_text(const nlohmann::json& score);
/// "LOST at 12.3 s, coverage 45.6 %" of an estimator's score.
[[nodiscard]] std::string outcome_line(const nlohmann::json& score);

/// The lines of one estimate's alignments: mode, scale, position and rotation error.
[[nodiscard]] std::string alignment_table(const nlohmann::json& alignments,
                                          const nlohmann::json& unavailable);

/// What to know of the images before trusting the scores, a line each: imagery that limits the
/// result, late tiles, faults. Empty when there is nothing to say.
[[nodiscard]] std::string camera_notes(const nlohmann::json& metrics);

}  // namespace overfly::app
