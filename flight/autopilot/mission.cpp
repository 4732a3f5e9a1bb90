#include "flight/autopilot/mission.hpp"

#include <cmath>
#include <string>

#include "core/text/number_text.hpp"

namespace overfly::autopilot {
namespace {

Status check_range(const char* field, double value, double low, double high) {
  if (value >= low && value <= high) return {};
  return Error{ErrorCode::kInvalidArgument,
               std::string(field) + " = " + number_text(value) + ": must be in [" +
                   number_text(low) + ", " + number_text(high) + "]"};
}

Status check_item(const MissionItem& item) {
  constexpr double kFarM = 1e6;
  if (item.command == MissionCommand::kSetSpeed) {
    return check_range("airspeed_m_s", item.airspeed_m_s, 5.0, 80.0);
  }
  if (Status s = check_range("east_m", item.position_m.x(), -kFarM, kFarM); !s) return s;
  if (Status s = check_range("north_m", item.position_m.y(), -kFarM, kFarM); !s) return s;
  if (Status s = check_range("height_m", item.height_m, -12000.0, 20000.0); !s) return s;
  if (item.radius_m != 0.0 || std::isnan(item.radius_m)) {
    if (Status s = check_range("radius_m", std::abs(item.radius_m), 1.0, 10000.0); !s) return s;
  }
  if (Status s = check_range("turns", item.turns.value_or(0.0), 0.0, 10000.0); !s) return s;
  if (Status s = check_range("accept_radius_m", item.accept_radius_m, 0.0, 10000.0); !s) return s;
  return check_range("time_s", item.time_s.value_or(0.0), 0.0, 86400.0);
}

}  // namespace

Status check(const Mission& mission) {
  if (mission.items.empty() || mission.items.size() > kMissionItemsMax) {
    return Error{ErrorCode::kInvalidArgument,
                 "a mission of " + std::to_string(mission.items.size()) +
                     " items: must have from 1 to " + std::to_string(kMissionItemsMax)};
  }
  for (std::size_t i = 0; i < mission.items.size(); ++i) {
    const MissionItem& item = mission.items[i];
    const std::string place =
        "mission item " + std::to_string(item.number != 0 ? item.number : i + 1);
    if (Status status = check_item(item); !status) return status.error().in(place);
    if (item.command == MissionCommand::kTakeOff && i != 0) {
      return Error{ErrorCode::kInvalidArgument,
                   place + ": a take-off must be the first item of the mission"};
    }
    if (item.command == MissionCommand::kLand && i + 1 != mission.items.size()) {
      return Error{ErrorCode::kInvalidArgument,
                   place + ": a landing must be the last item of the mission"};
    }
  }
  return {};
}

}  // namespace overfly::autopilot
