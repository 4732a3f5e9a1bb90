// The exact numbers of a report, for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "server/report/report_content.hpp"

namespace overfly::server::report {

/// {"format_version": 1, "alignment", "runs": [{"run", "label", "status", "metrics", "axes",
/// "latency"}], "left_out"}. `metrics` are those of `overfly evaluate --run DIR --alignment all
/// --json`; `axes.ESTIMATOR.MODE` are errors in the axes of the path; docs/REPORT.md has the
/// fields.
[[nodiscard]] nlohmann::json report_data(const ReportContent& content);

/// As a block of the page that is data and not run, whatever the texts in it contain.
[[nodiscard]] std::string data_block(const nlohmann::json& data);

}  // namespace overfly::server::report
