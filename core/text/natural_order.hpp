// The order in which people expect names with numbers.
#pragma once

#include <string>

namespace overfly {

/// Compares the numbers in names as numbers: "9.png" before "10.png". Names with equal numbers
/// ("01", "1") are compared by characters.
[[nodiscard]] bool before_naturally(const std::string& a, const std::string& b);

}  // namespace overfly
