// The mission of a scenario as a plan of QGroundControl.
#pragma once

#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// The scenario's plan, or its mission file's; text missions are converted. It is not moved to
/// `home`.
/// Errors: kInvalidArgument if the scenario flies no mission; as read_mission_file.
[[nodiscard]] Result<nlohmann::json> mission_plan(const Scenario& scenario);

}  // namespace overfly::server
