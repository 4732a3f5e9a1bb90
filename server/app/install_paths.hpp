// Locates the program's files: next to it, installed, or in the source tree.
#pragma once

#include <filesystem>

namespace overfly::app {

/// The built dashboard; empty if there is none.
[[nodiscard]] std::filesystem::path web_folder();
/// The scenarios that come with the program; as a last resort `scenarios` in the working folder.
[[nodiscard]] std::filesystem::path scenarios_folder();

}  // namespace overfly::app
