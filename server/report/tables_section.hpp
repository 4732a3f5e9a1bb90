// The tables of a report: all scores, what differs between the runs, and where they come from.
#pragma once

#include <string>

#include "server/report/report_content.hpp"

namespace overfly::server::report {

/// HTML. Of the differences nothing for a single run.
[[nodiscard]] std::string differences_section(const ReportContent& content);
/// Every estimator of every run by every alignment.
[[nodiscard]] std::string scores_section(const ReportContent& content);
/// Program, world, estimators and parameters; every field of manifest and scenario folded.
[[nodiscard]] std::string provenance_section(const ReportContent& content);

}  // namespace overfly::server::report
