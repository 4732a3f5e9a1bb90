// The tables of a report: all scores, what differs between the runs, and where they come from.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "server/report/report_content.hpp"

namespace overfly::server::report {

/// What a run is made of, for comparing runs: its scenario as flown, the parameters that its
/// estimators used, and of its manifest what the scenario does not say.
[[nodiscard]] nlohmann::json compared_document(const ReportRun& run);

/// HTML. Of the differences nothing for a single run.
[[nodiscard]] std::string differences_section(const ReportContent& content);
/// Every estimator of every run by every alignment.
[[nodiscard]] std::string scores_section(const ReportContent& content);
/// Program, world, estimators and parameters; every field of manifest and scenario folded.
[[nodiscard]] std::string provenance_section(const ReportContent& content);

}  // namespace overfly::server::report
