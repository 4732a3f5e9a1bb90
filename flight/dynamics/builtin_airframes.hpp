// The airframes that travel in the program: the files of scenarios/airframes.
#pragma once

#include <span>
#include <string_view>

namespace overfly::dynamics {

struct BuiltinAirframe {
  std::string_view name;  ///< of the file, without its extension
  std::string_view text;  ///< for parse_airframe
};

/// In the order of their names.
[[nodiscard]] std::span<const BuiltinAirframe> builtin_airframes();

}  // namespace overfly::dynamics
