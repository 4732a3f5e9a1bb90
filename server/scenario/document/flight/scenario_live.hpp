// Flights of live vehicles in scenario documents.
#pragma once

#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "flight/live/fly_live.hpp"
#include "server/scenario/document/scenario_layers.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// Reads `flight.mavlink`. @pre it is valid and has its defaults
/// Errors: kInvalidArgument naming the field, its value and its limit.
[[nodiscard]] Result<flight::live::LiveFlight> read_live_flight(nlohmann::json& mavlink,
                                                                const FileResolver& files);

/// Finds the estimator of `flight.mavlink.feedback`. @pre flight and estimators are read
/// Errors: kInvalidArgument if there is none of that name.
[[nodiscard]] Status find_feedback_estimator(const nlohmann::json& document, Scenario& scenario);

}  // namespace overfly::server
