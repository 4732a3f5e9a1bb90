// overfly bench: the speed of the flight model.
#pragma once

#include <nlohmann/json.hpp>

#include "core/result.hpp"

namespace overfly::app {

/// Flies the 1/3-scale Cub of `scenarios/airframes` at 25 m/s.
/// @return airframe, rate_hz, times_real_time
[[nodiscard]] Result<nlohmann::json> bench_dynamics();

}  // namespace overfly::app
