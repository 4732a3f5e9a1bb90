// Inside terrain only: digests of data files, for the record of a run.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace overfly::terrain {

/// "sha256:..." of the whole file up to 32 MiB. For larger files "sha256-sampled:..." of the size
/// and of 32 evenly spaced MiB, so that opening a large world stays fast.
/// Errors: kIo.
[[nodiscard]] Result<std::string> file_digest(const std::filesystem::path& file);

/// Whether most of the file's bytes do not contribute to a digest: equal digests then do not mean
/// equal contents.
[[nodiscard]] bool digest_is_sampled(std::string_view digest);

}  // namespace overfly::terrain
