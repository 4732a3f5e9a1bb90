// A mission's report as JSON (docs/PROTOCOL.md).
#pragma once

#include <nlohmann/json.hpp>

#include "server/missions/mission_report.hpp"

namespace overfly::server {

[[nodiscard]] nlohmann::json json_from(const MissionReport& report);

}  // namespace overfly::server
