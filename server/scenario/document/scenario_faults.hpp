// The faults of a scenario document.
#pragma once

#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// Index of a camera by name.
/// Errors: kInvalidArgument naming the field `path`, the value and the existing names.
[[nodiscard]] Result<std::size_t> camera_index(const Scenario& scenario,
                                               const nlohmann::json& name,
                                               const std::string& path);

/// @pre the document is valid, and the scenario has its cameras, sensors and seed
/// Errors: kInvalidArgument with field, value and limit.
[[nodiscard]] Status read_faults(const nlohmann::json& document, Scenario& scenario);

}  // namespace overfly::server
