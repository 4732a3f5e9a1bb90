// The report of `overfly track` for people.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace overfly::app {

/// @param report  as engine::report_json, with `out`, the trajectory's file
[[nodiscard]] std::string track_summary(const nlohmann::json& report);

}  // namespace overfly::app
