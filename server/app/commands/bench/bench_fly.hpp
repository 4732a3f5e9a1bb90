// overfly bench --fly-km: a long flight over a strip made for it.
#pragma once

#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "renderer/probes/endurance.hpp"
#include "server/app/progress.hpp"

namespace overfly::app {

/// Makes a strip of 0.5 m/px imagery, 4 km wide and slightly longer than the flight, in a temporary
/// folder and flies over it in lockstep.
/// Errors: as synthesize_strip, open_world and fly_endurance.
[[nodiscard]] Result<nlohmann::json> bench_long_flight(const renderer::EnduranceOptions& options,
                                                       ProgressDisplay& display);

void print_long_flight(const nlohmann::json& result);

}  // namespace overfly::app
