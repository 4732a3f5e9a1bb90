// The report of `overfly track` as text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace overfly::app {

/// @param report  from engine::report_json, with `out`, the trajectory's file
[[nodiscard]] std::string track_summary(const nlohmann::json& report);

}  // namespace overfly::app
