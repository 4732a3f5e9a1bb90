// Division rounded down, for places counted from a grid's corner in both directions.
#pragma once

namespace overfly::terrain {

/// @pre b > 0
[[nodiscard]] constexpr int floor_div(int a, int b) { return a / b - (a % b < 0 ? 1 : 0); }

}  // namespace overfly::terrain
