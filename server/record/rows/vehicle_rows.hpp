// Lines of vehicle.jsonl: what a live vehicle said of itself (docs/RUN_FOLDER.md).
#pragma once

#include <nlohmann/json.hpp>

#include "core/motion/flight_event.hpp"
#include "core/result.hpp"

namespace overfly::server {

/// Every field is there; null: not known.
[[nodiscard]] nlohmann::json json_from(const VehicleStatus& status);
/// Errors: kUnreadable naming the field.
[[nodiscard]] Result<VehicleStatus> vehicle_status_from(const nlohmann::json& value);

}  // namespace overfly::server
