// Gives a finished file its name, without replacing another file.
#pragma once

#include <filesystem>

#include "core/result.hpp"

namespace overfly::server {

/// Renames a file or folder unless the new name is taken, in one step. On file systems without hard
/// links (FAT, many network and FUSE file systems), and for folders, by renameat2, on others by
/// link. Where neither is supported (folders on NFS), by take_reserved_name.
/// @return false if the name is taken
/// Errors: kIo naming the file.
[[nodiscard]] Result<bool> take_free_name(const std::filesystem::path& file,
                                          const std::filesystem::path& name);

/// As take_free_name, in two steps: creates an empty file or folder of the name, which fails if it
/// is taken, and renames the other one onto that. A program that is killed in between leaves it.
[[nodiscard]] Result<bool> take_reserved_name(const std::filesystem::path& file,
                                              const std::filesystem::path& name);

}  // namespace overfly::server
