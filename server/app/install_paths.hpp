// Where the program finds what belongs to it: beside itself, installed, or in the source tree.
#pragma once

#include <filesystem>

namespace overfly::app {

/// The built dashboard; empty when there is none.
[[nodiscard]] std::filesystem::path web_folder();
/// The scenarios that come with the program; `scenarios` of the working folder as a last resort.
[[nodiscard]] std::filesystem::path scenarios_folder();

}  // namespace overfly::app
