// Numbers and outcomes in words.
#pragma once

#include <optional>
#include <string>

#include "server/report/run/report_run.hpp"

namespace overfly::server::report {

/// Four significant digits, never fewer than the whole part: "0.03412", "3.412", "34123"; "< 1e-6"
/// for what rounding leaves. An en dash for a number that is not finite, and for none.
[[nodiscard]] std::string figure_text(double value);
[[nodiscard]] std::string figure_text(const std::optional<double>& value);

/// "COMPLETED", "LOST at 12.3 s, after 500 m; found its map again at 15.1 s", with no-break spaces
/// before the units.
[[nodiscard]] std::string outcome_text(const evaluation::Score& score);

/// What an estimator did, as a predicate: "was lost at 12.3 s".
[[nodiscard]] std::string outcome_words(const EstimatorMetrics& metrics);

/// "found its map again at 15.1 s", "found its map again 2 times, first at 15.1 s"; empty if it
/// never did.
[[nodiscard]] std::string relocalised_words(const evaluation::Score& score);

/// The circumstances of the outcome: attitude, rate of turn, depth of the ground, texture,
/// saturation and faults in the camera's frame at the outcome's time. Empty for outcomes without a
/// time.
[[nodiscard]] std::string circumstances(const ReportRun& run, const ReportEstimate& estimate);

/// "run 2: orb", or only the estimator's name.
[[nodiscard]] std::string name_of(const ReportRun& run, const ReportEstimate& estimate);

/// Position error as a share of the flown path, in percent; empty without a path.
[[nodiscard]] std::optional<double> percent_of_path(const ReportRun& run, double position_m);

}  // namespace overfly::server::report
