// Flies one scenario and records it in one run folder.
#pragma once

#include "core/result.hpp"
#include "server/run/run_options.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// Flies, estimates, records and scores; returns when the folder is complete.
/// Errors: kConflict if the folder contains a run; any error of world, renderer, flight or
/// estimator. A lost, diverged or crashed estimator is a result, not an error.
[[nodiscard]] Result<RunResult> run_scenario(const Scenario& scenario, const RunOptions& options);

}  // namespace overfly::server
