// Writes files completely or not at all.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>

#include "core/result.hpp"

namespace overfly::flight::logs {

/// Writes a file completely or not at all, without holding it in memory.
/// Errors: kIo naming the file.
[[nodiscard]] Status write_whole_file(const std::filesystem::path& file,
                                      const std::function<void(std::ofstream&)>& write);

}  // namespace overfly::flight::logs
