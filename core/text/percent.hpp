// Percentages for display.
#pragma once

#include <string>

namespace overfly {

/// Formats a share in [0, 1] as a percentage with two significant digits, "6.1 %". Above 50 % the
/// two digits apply to the remainder, "99.944 %". Only 0 gives "0 %" and only 1 gives "100 %".
[[nodiscard]] std::string percent_text(double share);

}  // namespace overfly
