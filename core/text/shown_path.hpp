// Messages for clients, without the folders of this machine.
#pragma once

#include <filesystem>
#include <string>

namespace overfly {

/// A message with `shown` in place of a file's path, and without the path of a folder in front of
/// the files inside it.
/// @param path  of the file or folder; with an empty one the message stays as it is
[[nodiscard]] std::string shown_without(const std::filesystem::path& path,
                                        const std::string& shown,
                                        std::string message);

}  // namespace overfly
