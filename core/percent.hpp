// Shares for people.
#pragma once

#include <string>

namespace overfly {

/// A share in [0, 1] as a percentage of two significant digits, "6.1 %"; near the whole the digits
/// are those that tell what is missing from it, "99.944 %". Only 0 is "0 %", only 1 is "100 %".
[[nodiscard]] std::string percent_text(double share);

}  // namespace overfly
