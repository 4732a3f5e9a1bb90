// An explanation as JSON (docs/EXPLAIN.md).
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "server/experiments/explain/explanation.hpp"

namespace overfly::server::experiments {

/// @param folder  of the explanation: run folders are given relative to it
[[nodiscard]] nlohmann::json json_from(const Explanation& explanation,
                                       const std::filesystem::path& folder);

}  // namespace overfly::server::experiments
