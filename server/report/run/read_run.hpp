// Reads a run for a report.
#pragma once

#include <filesystem>

#include "core/result.hpp"
#include "server/report/run/report_run.hpp"

namespace overfly::server::report {

/// Reads a run that is over, also one that failed or was interrupted, and scores it from its rows,
/// exactly as `overfly evaluate --run` does. Nothing is written.
/// @param shown  the alignment of the poses and errors over time
/// Errors: as RunTimeline::open; kConflict for a run that is not over;
/// kNotFound for one without frames.
[[nodiscard]] Result<ReportRun> read_report_run(const std::filesystem::path& folder,
                                                evaluation::AlignmentMode shown);

}  // namespace overfly::server::report
