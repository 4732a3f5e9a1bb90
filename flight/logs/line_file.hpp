// Writes text files line by line.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>

#include "core/result.hpp"

namespace overfly::flight::logs {

/// Writes a file of lines completely or not at all, without holding it in memory. Errors: kIo.
[[nodiscard]] Status write_lines(const std::filesystem::path& file,
                                 const std::function<void(std::ofstream&)>& write);

}  // namespace overfly::flight::logs
