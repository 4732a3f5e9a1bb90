#include "server/missions/mission_plan.hpp"

#include "core/outside/file_text.hpp"
#include "core/outside/outside_json.hpp"
#include "flight/mavlink/vehicle/plan_file.hpp"

namespace overfly::server {

Result<nlohmann::json> mission_plan(const Scenario& scenario) {
  using flight::mavlink::StoredMission;
  constexpr std::uint64_t kMaxBytes = std::uint64_t{16} << 20U;
  const auto* mission = std::get_if<ScenarioMission>(&scenario.flight);
  if (mission == nullptr) {
    return Error{ErrorCode::kInvalidArgument, "flight = another kind: must be a mission"};
  }
  if (!mission->plan.empty()) {
    return json_from_outside<nlohmann::json>(mission->plan, "flight.mission.plan");
  }
  // Also of a plan: what it contains must be what can be flown.
  const Result<StoredMission> stored = flight::mavlink::read_mission_file(mission->file);
  if (!stored) return stored.error();
  const std::string origin = mission->file.filename().string();
  if (!flight::mavlink::is_plan_file(mission->file)) {
    return json_from_outside<nlohmann::json>(flight::mavlink::plan_text(stored->items), origin);
  }
  const Result<std::string> text = read_file_text(mission->file, kMaxBytes);
  if (!text) return text.error();
  return json_from_outside<nlohmann::json>(*text, origin);
}

}  // namespace overfly::server
