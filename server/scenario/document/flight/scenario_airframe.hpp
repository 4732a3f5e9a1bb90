// Reads airframes, wind, turbulence and autopilot parameters of a scenario document.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/result.hpp"
#include "server/scenario/document/scenario_layers.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// @param flight  the object that has `wind`, `turbulence` and `autopilot`, valid by the schema,
///                with its defaults; the path of an airframe file is resolved
/// @param field   of the airframe in it, and `path` the object's own path, for messages
/// Errors: kInvalidArgument for a name that is neither a built-in airframe nor a .json file.
[[nodiscard]] Result<AirframeChoice> read_airframe_choice(nlohmann::json& flight,
                                                          const std::string& field,
                                                          const std::string& path,
                                                          const FileResolver& files);

}  // namespace overfly::server
