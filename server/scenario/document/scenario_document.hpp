// Converts a valid scenario document to values.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// @param document  valid by the schema, with its defaults filled in
/// @param base  absolute folder of the scenario file
/// Errors: kInvalidArgument for violations that the schema cannot express (two estimators of the
/// same name, ...).
[[nodiscard]] Result<Scenario> scenario_from(nlohmann::json document,
                                             const std::filesystem::path& base);

}  // namespace overfly::server
