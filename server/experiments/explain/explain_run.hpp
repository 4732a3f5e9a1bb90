// Explains why an estimator failed: flies the critical part of its flight again with one cause
// changed at a time.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/experiments/explain/explanation.hpp"
#include "server/experiments/explain/reflights.hpp"

namespace overfly::server::experiments {

struct ExplainOptions {
  std::string estimator;  ///< empty: the first one that failed, else the first
  /// Causes to be tried; empty: all. Those that change every flight (texture, roll rate, features,
  /// start) are tried only if no disturbance explains the failure, unless they are named here.
  std::vector<Cause> causes;
  ReflightOptions flights;
};

/// Explains the failure of one estimator of a completed run. The method:
///
/// 1. The shortest part of the flight that shows the failure again, with nothing changed.
/// 2. Each disturbance that the flight has is taken away by itself, and all of them together. A
///    cause without which the estimator survives is necessary.
/// 3. Each necessary disturbance stays while all others are taken away. If the estimator still
///    fails, the cause is sufficient. If none is necessary, each one is tried, which finds those
///    of which every one is enough; then pairs.
/// 4. If the estimator fails without any disturbance, texture, features, roll rate and start are
///    changed.
/// 5. What was found is flown again with other random numbers, and causes that fail this test are
///    not named.
/// 6. The margin of the first cause that can be scaled is found by bisection.
///
/// A run that succeeded needs no flight.
/// Errors: kInvalidArgument for an unknown estimator, a run that is not completed, one with
/// recorded images, and options beyond their limits; as read_json, read_run_metrics and
/// Reflights::fly; kConflict if another process works in the folder.
[[nodiscard]] Result<Explanation> explain_run(const std::filesystem::path& run_folder,
                                              const ExplainOptions& options);

}  // namespace overfly::server::experiments
