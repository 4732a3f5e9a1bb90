// Reads `flight.log` of a scenario document.
#pragma once

#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "server/scenario/document/scenario_layers.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// @param log  `flight.log`, valid by the schema and with its defaults; file names are resolved
/// Errors: kInvalidArgument for violations that the schema cannot express.
[[nodiscard]] Result<LoggedFlight> logged_flight_from(nlohmann::json& log,
                                                      const FileResolver& files);

}  // namespace overfly::server
