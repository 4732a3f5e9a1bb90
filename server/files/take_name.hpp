// Gives a finished file its name, without replacing another file.
#pragma once

#include <filesystem>

#include "core/result.hpp"

namespace overfly::server {

/// Renames a file unless the new name is taken, in one step. On file systems without hard links
/// (FAT, many network and FUSE file systems) by renameat2, on others by link.
/// @return false if the name is taken
/// Errors: kIo naming the file.
[[nodiscard]] Result<bool> take_free_name(const std::filesystem::path& file,
                                          const std::filesystem::path& name);

}  // namespace overfly::server
