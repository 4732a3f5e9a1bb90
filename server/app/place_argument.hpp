// A place on the earth on the command line.
#pragma once

#include <string>

#include "core/earth/geodesy.hpp"
#include "core/result.hpp"

namespace overfly::app {

/// "LAT,LON,HEIGHT" in degrees and metres.
/// Errors: kInvalidArgument naming the option, its value and its limits.
[[nodiscard]] Result<Geodetic> place_from(const std::string& option, const std::string& text);

}  // namespace overfly::app
