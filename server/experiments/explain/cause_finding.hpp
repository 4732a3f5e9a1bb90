// What an explanation has found of each cause.
#pragma once

#include <optional>
#include <vector>

#include "server/experiments/explain/explanation.hpp"

namespace overfly::server::experiments {

struct CauseFinding {
  Cause cause = Cause::kFaults;
  std::optional<bool> necessary;   ///< without it the estimator survives; empty: not tried
  std::optional<bool> sufficient;  ///< with everything else taken away it fails; empty: not tried
  std::optional<CauseMargin> margin;
};

/// Of each cause that a flight says something about, the named ones first.
[[nodiscard]] std::vector<CauseFinding> findings_of(const Explanation& explanation);

}  // namespace overfly::server::experiments
