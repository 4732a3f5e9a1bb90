// Inside terrain only: digests of data files, for the record of a run.
#pragma once

#include <filesystem>
#include <string>

#include "core/result.hpp"

namespace overfly::terrain {

/// "sha256:..." of the whole file up to 32 MiB. For larger files "sha256-sampled:..." of the size
/// and of 32 evenly spaced MiB, so that opening a large world stays fast.
/// Errors: kIo.
[[nodiscard]] Result<std::string> file_digest(const std::filesystem::path& file);

}  // namespace overfly::terrain
