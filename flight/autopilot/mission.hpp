// A mission: what the aircraft flies, item by item.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/result.hpp"

namespace overfly::autopilot {

enum class MissionCommand {
  kTakeOff,   ///< climb straight ahead to the position's height
  kWaypoint,  ///< fly to the position along the line from the item before it
  /// Circle around the position: for `turns`, for `time_s`, until the height is reached and the
  /// course points to the next item, or until the end.
  kLoiter,
  kReturn,    ///< fly home at RTL_ALTITUDE and circle there as in kLoiter
  kLand,      ///< descend along the line to the position, and touch down
  kSetSpeed,  ///< change the airspeed, at once
};

struct MissionItem {
  MissionCommand command = MissionCommand::kWaypoint;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< east, north, in the world frame
  double height_m = 0.0;  ///< up in the world frame, or above the ground
  bool above_ground = false;
  double radius_m = 0.0;  ///< of a circle, < 0 to the left; 0: WP_LOITER_RAD
  std::optional<double> turns;
  std::optional<double> time_s;
  bool until_height = false;
  double airspeed_m_s = 0.0;     ///< of kSetSpeed
  std::uint16_t number = 0;      ///< in the mission's file or at the ground station; 0: none
  double accept_radius_m = 0.0;  ///< of a waypoint; 0: WP_RADIUS or the turn's lead
};

struct Mission {
  Eigen::Vector3d home_world_m = Eigen::Vector3d::Zero();  ///< on the ground
  std::vector<MissionItem> items;
};

inline constexpr std::size_t kMissionItemsMax = 10000;

/// Errors: kInvalidArgument naming item (its number, or from 1), field, value and limit.
[[nodiscard]] Status check(const Mission& mission);

}  // namespace overfly::autopilot
