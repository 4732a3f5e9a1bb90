#pragma once

#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// Rejects settings that only the machine's own scenarios may contain: an estimator whose command,
/// addresses or parameters that may name files (text with a slash) differ from those of every
/// estimator of the `trusted` scenarios, and a live flight that differs from that of each of them.
/// Errors: kForbidden naming the field.
[[nodiscard]] Status check_reach(const Scenario& scenario, const std::vector<Scenario>& trusted);

/// Rejects a live flight on a link that is not one of `allowed`.
/// Errors: kInvalidArgument naming the field.
[[nodiscard]] Status check_link(const Scenario& scenario, const std::vector<std::string>& allowed);

}  // namespace overfly::server
