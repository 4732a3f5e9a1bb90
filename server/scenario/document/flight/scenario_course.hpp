// Reads `flight.course` and `flight.mission` of a scenario document.
#pragma once

#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "server/scenario/document/scenario_layers.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// @param course  valid by the schema, with its defaults; the path of an airframe file is resolved
/// Errors: kInvalidArgument for a leg longer than the course, and for wind, turbulence, constant
/// height or autopilot parameters without an airframe.
[[nodiscard]] Status read_course(nlohmann::json& course,
                                 const FileResolver& files,
                                 Scenario& scenario);

/// @param mission  as above; the paths of mission and airframe files are resolved
/// Errors: as read_airframe_choice; kInvalidArgument naming a field of the plan.
[[nodiscard]] Result<ScenarioMission> read_mission(nlohmann::json& mission,
                                                   const FileResolver& files);

}  // namespace overfly::server
