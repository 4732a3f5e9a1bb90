#pragma once

#include "core/result.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// Rejects settings that only the machine's own scenarios may contain: an estimator whose command,
/// addresses or parameters that may name files (text with a slash) differ from those of every
/// estimator in `trusted`.
/// Errors: kInvalidArgument naming the field.
[[nodiscard]] Status check_reach(const Scenario& scenario, const Scenario& trusted);

}  // namespace overfly::server
