// The top of a report: which estimator survived, how well, and what to know about it.
#pragma once

#include <string>

#include "server/report/report_content.hpp"

namespace overfly::server::report {

/// HTML.
[[nodiscard]] std::string summary_section(const ReportContent& content);

}  // namespace overfly::server::report
