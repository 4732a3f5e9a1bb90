// The info of one run, read from its folder.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/result.hpp"
#include "server/record/run_info.hpp"

namespace overfly::server {

/// Maximum size of a file that is read for a list of runs.
inline constexpr std::uint64_t kMostListedBytes = std::uint64_t{16} << 20U;

/// Reads the manifest and created.json; counts the written frames if the run did not reach its end.
/// A run that is marked as running but whose lock is free is reported as interrupted. An invalid
/// file or field is reported in `problem`; the other fields are still read.
/// Errors: kNotFound if there is no manifest.
[[nodiscard]] Result<RunInfo> read_run_info(const std::filesystem::path& folder);

}  // namespace overfly::server
