// Flies what a sweep lacks into its folder.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "core/result.hpp"
#include "server/experiments/sweep_plan.hpp"
#include "server/experiments/sweep_results.hpp"

namespace overfly::server::experiments {

struct SweepProgress {
  std::size_t passed = 0;  ///< flights that are over or need not be flown
  std::size_t most = 0;    ///< flights at most
  std::size_t flown = 0;   ///< in this call
  std::size_t failed = 0;  ///< in this call
  double left_s = 0.0;     ///< estimate for the rest; 0 before the first flight is over
  double spent_s = 0.0;    ///< by the flights of this call, one after the other
};

struct SweepOptions {
  std::filesystem::path folder;   ///< created if absent
  std::filesystem::path program;  ///< this program, which flies single scenarios
  std::size_t jobs = 1;           ///< flights at the same time, if the memory suffices
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(const SweepProgress&)> progress;
  std::function<void(const std::string&)> warn;
};

/// A sweep and its results so far.
struct FlownSweep {
  SweepPlan plan;
  SweepResults results;
  SweepProgress progress;
  bool cancelled = false;
};

/// Flies every flight without a result. Results are kept in the folder: a call that was cancelled
/// or killed is continued by the next one, and a sweep with more cells or a changed estimator flies
/// only what is new. A flight that fails is flown again up to Sweep::retries times, then recorded
/// as failed; the next call tries it again. Errors: as SweepPlan::make; kConflict if another
/// process works on the folder; kUnsupported if a flight needs more memory than there is; kIo.
[[nodiscard]] Result<FlownSweep> fly_sweep(const Sweep& sweep, const SweepOptions& options);

/// Reads the results in a folder without flying.
/// Errors: as fly_sweep.
[[nodiscard]] Result<FlownSweep> read_sweep(const Sweep& sweep,
                                            const std::filesystem::path& folder);

}  // namespace overfly::server::experiments
