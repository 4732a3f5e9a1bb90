// Checks the options of the process door.
#pragma once

#include "core/result.hpp"
#include "vo_bridges/process/process_estimator.hpp"

namespace overfly::process {

/// Errors: kInvalidArgument naming the first option outside its limits, its value and the limit.
[[nodiscard]] Status validate(const ProcessEstimatorOptions& options);

}  // namespace overfly::process
