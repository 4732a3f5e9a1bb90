// Missions of ground stations as missions of the built-in aircraft.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/earth/geodesy.hpp"
#include "core/earth/height_query.hpp"
#include "core/result.hpp"
#include "flight/autopilot/mission.hpp"
#include "flight/mavlink/vehicle/mission.hpp"

namespace overfly::autopilot {

struct PlannedMission {
  Mission mission;
  double heading_rad = 0.0;           ///< from home to the first position, clockwise from north
  std::vector<std::string> warnings;  ///< items that were left out
};

/// Converts MAVLink mission items; item 0 is home. Heights above home and above sea level (frames
/// 0, 3, 5, 6) keep their difference from home's, those above terrain (10, 11) follow the ground.
/// Commands: NAV_WAYPOINT, NAV_LOITER_UNLIM, _TURNS, _TIME, _TO_ALT, NAV_RETURN_TO_LAUNCH,
/// NAV_LAND, NAV_TAKEOFF, DO_CHANGE_SPEED of the airspeed. Other DO_ and CONDITION_ commands are
/// left out with a warning. A take-off and a return have no position of their own. An endless
/// circle at the end of the mission is flown once.
/// @param home_m  moves the mission so that its home lies there (east, north); empty: where it is
/// Errors: kInvalidArgument naming item and value for other commands and frames, positions out of
/// range, and a mission without items that move; check(Mission).
[[nodiscard]] Result<PlannedMission> plan_mission(
    const std::vector<flight::mavlink::MissionItem>& items,
    const LocalFrame& frame,
    const HeightQuery& ground,
    const std::optional<Eigen::Vector2d>& home_m);

}  // namespace overfly::autopilot
