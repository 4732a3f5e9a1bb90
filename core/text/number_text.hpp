// Numbers as text, for files that must be read back exactly.
#pragma once

#include <cstdint>
#include <string>

namespace overfly {

/// The shortest decimal that parses to the same double.
[[nodiscard]] std::string number_text(double value);
/// Seconds with nine decimals, exact.
[[nodiscard]] std::string seconds_text(std::int64_t t_ns);

}  // namespace overfly
