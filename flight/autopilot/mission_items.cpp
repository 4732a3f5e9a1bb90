#include "flight/autopilot/mission_items.hpp"

#include <cmath>
#include <utility>

#include "core/motion/pose.hpp"
#include "core/text/number_text.hpp"

namespace overfly::autopilot {
namespace {

using Item = flight::mavlink::MissionItem;

/// MAV_CMD.
enum : std::uint16_t {
  kNavWaypoint = 16,
  kNavLoiterUnlimited = 17,
  kNavLoiterTurns = 18,
  kNavLoiterTime = 19,
  kNavReturn = 20,
  kNavLand = 21,
  kNavTakeOff = 22,
  kNavLoiterToAlt = 31,
  kFirstConditionOrDo = 112,
  kDoChangeSpeed = 178,
  kLastDo = 300,
};

Error item_error(std::size_t index, const std::string& text) {
  return {ErrorCode::kInvalidArgument, "mission item " + std::to_string(index) + ": " + text};
}

double finite_or_zero(float value) { return std::isfinite(value) ? value : 0.0; }

class Planner {
 public:
  Planner(const LocalFrame& frame,
          const HeightQuery& ground,
          const Item& home,
          const std::optional<Eigen::Vector2d>& home_m)
      : frame_(frame), home_(home) {
    const Eigen::Vector3d file_home = frame_.world_from_geodetic(
        geodetic_from_deg(home.x, home.y, frame_.origin().alt_ellipsoid_m));
    const Eigen::Vector2d placed = home_m.value_or(file_home.head<2>());
    offset_m_ = placed - file_home.head<2>();
    plan.mission.home_world_m = {
        placed.x(), placed.y(), ground.ground_up_m(placed.x(), placed.y())};
  }

  Status add(std::size_t index, const Item& from) {
    MissionItem item;
    item.number = static_cast<std::uint16_t>(index);
    switch (from.command) {
      case kNavWaypoint:
        item.accept_radius_m = finite_or_zero(from.parameters[1]);
        break;
      case kNavLoiterTurns:
        item.turns = finite_or_zero(from.parameters[0]);
        [[fallthrough]];
      case kNavLoiterUnlimited:
        item.command = MissionCommand::kLoiter;
        break;
      case kNavLoiterTime:
        item.command = MissionCommand::kLoiter;
        item.time_s = finite_or_zero(from.parameters[0]);
        break;
      case kNavLoiterToAlt:
        item.command = MissionCommand::kLoiter;
        item.until_height = true;
        break;
      case kNavReturn:
        item.command = MissionCommand::kReturn;
        break;
      case kNavLand:
        item.command = MissionCommand::kLand;
        break;
      case kNavTakeOff:
        item.command = MissionCommand::kTakeOff;
        break;
      case kDoChangeSpeed:
        return add_speed(index, from);
      default:
        return leave_out(index, from);
    }
    if (item.command == MissionCommand::kLoiter) {
      // The only circle whose radius is its second parameter.
      item.radius_m = finite_or_zero(from.parameters[item.until_height ? 1 : 2]);
    }
    if (item.command == MissionCommand::kReturn) {
      item.position_m = plan.mission.home_world_m.head<2>();
    } else if (Status status = place(index, from, item); !status) {
      return status;
    }
    plan.mission.items.push_back(item);
    return {};
  }

  PlannedMission plan;

 private:
  Status add_speed(std::size_t index, const Item& from) {
    constexpr double kAirspeed = 0.0;
    if (finite_or_zero(from.parameters[0]) != kAirspeed || !(from.parameters[1] > 0.0F)) {
      return leave_out(index, from);
    }
    MissionItem item;
    item.number = static_cast<std::uint16_t>(index);
    item.command = MissionCommand::kSetSpeed;
    item.airspeed_m_s = from.parameters[1];
    plan.mission.items.push_back(item);
    return {};
  }

  Status leave_out(std::size_t index, const Item& from) {
    if (from.command < kFirstConditionOrDo || from.command > kLastDo) {
      return item_error(index,
                        "command " + std::to_string(from.command) +
                            ": the built-in aircraft cannot fly it (known: 16 to 22, 31 and 178)");
    }
    plan.warnings.push_back("mission item " + std::to_string(index) + ": command " +
                            std::to_string(from.command) + " was left out");
    return {};
  }

  /// Of the last item that has one; a change of speed has none.
  [[nodiscard]] std::optional<Eigen::Vector2d> last_place_m() const {
    for (auto item = plan.mission.items.rbegin(); item != plan.mission.items.rend(); ++item) {
      if (item->command != MissionCommand::kSetSpeed) return item->position_m;
    }
    return std::nullopt;
  }

  Status place(std::size_t index, const Item& from, MissionItem& item) const {
    const bool take_off = item.command == MissionCommand::kTakeOff;
    if (!(std::abs(from.x) <= 90.0 && std::abs(from.y) <= 180.0)) {
      return item_error(
          index,
          "position " + number_text(from.x) + ", " + number_text(from.y) + " deg: is out of range");
    }
    // Ground stations write 0, 0 where a command needs no position: the place of the item before.
    if (from.x == 0.0 && from.y == 0.0) {
      const std::optional<Eigen::Vector2d> before_m = last_place_m();
      if (!take_off && !before_m) return item_error(index, "has no position");
      item.position_m = before_m.value_or(plan.mission.home_world_m.head<2>());
    } else {
      const Eigen::Vector3d at = frame_.world_from_geodetic(
          geodetic_from_deg(from.x, from.y, frame_.origin().alt_ellipsoid_m));
      item.position_m = at.head<2>() + offset_m_;
    }
    switch (from.frame) {
      case 0:
      case 5:
        item.height_m = from.z - home_.z + plan.mission.home_world_m.z();
        return {};
      case 3:
      case 6:
        item.height_m = from.z + plan.mission.home_world_m.z();
        return {};
      case 10:
      case 11:
        item.height_m = from.z;
        item.above_ground = true;
        return {};
      default:
        return item_error(
            index,
            "frame " + std::to_string(from.frame) + ": must be 0, 3, 5, 6, 10 or 11 (global)");
    }
  }

  const LocalFrame& frame_;
  const Item& home_;
  Eigen::Vector2d offset_m_;
};

}  // namespace

Result<PlannedMission> plan_mission(const std::vector<Item>& items,
                                    const LocalFrame& frame,
                                    const HeightQuery& ground,
                                    const std::optional<Eigen::Vector2d>& home_m) {
  if (items.size() < 2) {
    return Error{ErrorCode::kInvalidArgument,
                 "a mission of " + std::to_string(items.size()) +
                     " items: must have a home position and at least one item to fly"};
  }
  Planner planner(frame, ground, items.front(), home_m);
  for (std::size_t i = 1; i < items.size(); ++i) {
    if (Status status = planner.add(i, items[i]); !status) return status.error();
  }
  PlannedMission plan = std::move(planner.plan);
  if (!plan.mission.items.empty()) {
    MissionItem& last = plan.mission.items.back();
    const bool circles =
        last.command == MissionCommand::kLoiter || last.command == MissionCommand::kReturn;
    if (circles && !last.turns && !last.time_s && !last.until_height) last.turns = 1.0;
  }
  if (Status status = check(plan.mission); !status) return status.error();
  const Eigen::Vector2d home = plan.mission.home_world_m.head<2>();
  for (const MissionItem& item : plan.mission.items) {
    if (item.command == MissionCommand::kSetSpeed) continue;
    const Eigen::Vector2d way = item.position_m - home;
    if (way.norm() < 1.0) continue;
    plan.heading_rad = std::atan2(way.x(), way.y());
    break;
  }
  return plan;
}

}  // namespace overfly::autopilot
