// Quantities of one flight over time: states, errors, poses, latency, texture.
#pragma once

#include <string>
#include <vector>

#include "server/report/report_content.hpp"

namespace overfly::server::report {

/// @param run  whose truth is shown
/// @param id  of the figures: unique in the page
/// @return HTML
[[nodiscard]] std::string time_figures(const ReportContent& content,
                                       const ReportRun& run,
                                       const std::vector<ReportEntry>& entries,
                                       const std::string& id);

}  // namespace overfly::server::report
