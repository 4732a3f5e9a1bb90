// Division that rounds down, for grid positions that may be negative.
#pragma once

namespace overfly::terrain {

/// @pre b > 0
[[nodiscard]] constexpr int floor_div(int a, int b) { return a / b - (a % b < 0 ? 1 : 0); }

}  // namespace overfly::terrain
