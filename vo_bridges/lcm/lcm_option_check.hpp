// Checks the options of the LCM door before any communication.
#pragma once

#include "core/result.hpp"
#include "middleware/lcm/url.hpp"
#include "vo_bridges/lcm/lcm_options.hpp"

namespace overfly {

/// @return the parsed URL
/// Errors: kInvalidArgument naming option, value and limit.
[[nodiscard]] Result<lcm::Url> check_lcm_options(const LcmEstimatorOptions& options);

}  // namespace overfly
