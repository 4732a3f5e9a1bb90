// Plans of QGroundControl (.plan): JSON documents with a mission, a geofence and rally points.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "flight/mavlink/vehicle/mission.hpp"

namespace overfly::flight::mavlink {

/// Reads the mission of a plan (fileType "Plan", mission version 2; QGroundControl developer guide,
/// "Plan File Format"). The planned home position becomes item 0. Of complex items, surveys and
/// corridors contribute the items that the ground station stored with them, and a fixed-wing
/// landing pattern its approach and landing. Geofence and rally points are left out with a warning.
/// @param origin  names the plan in messages
/// Errors: kUnreadable for JSON syntax with line and column, and naming field, value and limit.
[[nodiscard]] Result<StoredMission> parse_plan(std::string_view text, const std::string& origin);

/// A plan with these items, item 0 as the planned home position, for QGroundControl and parse_plan.
/// @pre not empty
[[nodiscard]] std::string plan_text(const std::vector<MissionItem>& items);

}  // namespace overfly::flight::mavlink
