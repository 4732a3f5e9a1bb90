// Flies one scenario into one run folder.
#pragma once

#include "core/result.hpp"
#include "server/run/run_options.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::engine {

/// Flies, estimates, records and scores; returns when the folder is complete.
/// Errors: kConflict if the folder holds a run; whatever world, renderer, flight or estimator say.
/// A lost, diverged or crashed estimator is a result, not an error.
[[nodiscard]] Result<RunResult> run_scenario(const Scenario& scenario, const RunOptions& options);

}  // namespace overfly::engine
