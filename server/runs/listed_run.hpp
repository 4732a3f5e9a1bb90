// A run as lists of runs show it: its info with its results and what people wrote about it.
#pragma once

#include <filesystem>

#include "core/result.hpp"
#include "server/record/run_info.hpp"

namespace overfly::server {

/// Reads a run's info, the results in its metrics and its notes. Invalid metrics or notes are
/// reported in RunInfo::problem. Errors: as read_run_info.
[[nodiscard]] Result<RunInfo> read_listed_run(const std::filesystem::path& folder);

}  // namespace overfly::server
