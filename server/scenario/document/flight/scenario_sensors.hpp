// The sensors of a scenario document, in addition to the cameras.
#pragma once

#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// @pre the document is valid, with defaults filled in
/// Errors: kInvalidArgument with field, value and limit.
[[nodiscard]] Status read_sensors(const nlohmann::json& document, Scenario& scenario);

}  // namespace overfly::server
