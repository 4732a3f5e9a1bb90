// The estimators of a scenario document.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/result.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// Reads `estimators`, and makes the programs in their commands absolute, in the document too.
/// @pre the document is valid and has its defaults; cameras and pacing are read
/// @param base  absolute folder of the scenario file
/// Errors: kInvalidArgument with field, value and limit.
[[nodiscard]] Status read_estimators(nlohmann::json& document,
                                     const std::filesystem::path& base,
                                     Scenario& scenario);

}  // namespace overfly::server
