// The tracks of one flight over the ground and from the side.
#pragma once

#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/report/figures/map_picture.hpp"
#include "server/report/report_content.hpp"

namespace overfly::server::report {

/// The truth of the first entry's run and the estimates by the report's alignment.
/// @param id  of the figures: unique in the page
/// @return HTML. Errors: kCancelled.
[[nodiscard]] Result<std::string> track_figures(const ReportContent& content,
                                                const ReportRun& run,
                                                const std::vector<ReportEntry>& entries,
                                                const std::string& id,
                                                const MapOptions& options);

}  // namespace overfly::server::report
