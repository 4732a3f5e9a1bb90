// An explanation as a page: one HTML file that needs no other, no network and no script.
#pragma once

#include <filesystem>
#include <string>

#include "server/experiments/explain/explanation.hpp"

namespace overfly::server::experiments {

/// The answer in sentences, a picture of the causes and one of all flights, and a table that links
/// their run folders.
/// @param folder  in which the page will lie: links are relative to it
[[nodiscard]] std::string page_of(const Explanation& explanation,
                                  const std::filesystem::path& folder);

}  // namespace overfly::server::experiments
