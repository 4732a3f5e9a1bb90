// Flies what a sweep lacks into its folder.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/experiments/flights/flight_executor.hpp"
#include "server/experiments/pictures/flight_frame_cache.hpp"
#include "server/experiments/sweep_plan.hpp"
#include "server/experiments/sweep_progress.hpp"
#include "server/experiments/sweep_results.hpp"
#include "server/record/run_lock.hpp"
#include "server/runs/run_memory.hpp"

namespace overfly::server::experiments {

struct SweepOptions {
  std::filesystem::path folder;             ///< created if absent
  std::filesystem::path program;            ///< this program, which flies single scenarios
  std::vector<std::string> flight_options;  ///< further options of `overfly run`
  /// The folder's, from lock_sweep, by those who make several calls; null: each call takes it.
  const RunLock* lock = nullptr;
  std::size_t jobs = 1;  ///< flights given to the executor at the same time, if the memory suffices
  /// Pictures are kept for flights that probably have the same ones: other repeats and cells, and
  /// flights of changed estimators. Only used without open_executor.
  FlightFrameCache frame_cache;
  bool pictures_recur = false;  ///< flights of other calls probably have the same pictures
  /// Makes what flies the flights, when the folder is locked. Empty: processes of this machine.
  std::function<Result<std::unique_ptr<FlightExecutor>>()> open_executor;
  /// Memory for one more flight, for as long as the result lives; null while there is not enough.
  /// Empty: four fifths of the machine's memory are this sweep's own.
  std::function<std::shared_ptr<const void>(const RunMemory&)> hold_memory;
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(const SweepProgress&)> progress;
  bool writes_progress = true;  ///< into the folder; false: the caller does
  std::function<void(const std::string&)> warn;
};

/// A sweep and its results so far.
struct FlownSweep {
  SweepPlan plan;
  SweepResults results;
  SweepProgress progress;
  bool cancelled = false;
  PictureCount pictures;  ///< of this call's flights
};

/// Creates the folder of a sweep if it is absent, and keeps other processes from working on it.
/// Errors: as RunLock::take; kIo.
[[nodiscard]] Result<RunLock> lock_sweep(const std::filesystem::path& folder);

/// Flies every flight without a result. Results are kept in the folder: a call that was cancelled
/// or killed is continued by the next one, and a sweep with more cells or a changed estimator flies
/// only what is new. A flight that fails is flown again up to Sweep::retries times, then recorded
/// as failed; the next call tries it again. Errors: as SweepPlan::make; kConflict if another
/// process works on the folder; kUnsupported if a flight needs more memory than there is; kIo;
/// kCancelled before the first flight.
[[nodiscard]] Result<FlownSweep> fly_sweep(const Sweep& sweep, const SweepOptions& options);

/// Withdraws the outdated_results of a sweep's folder; fly_sweep does so before it flies.
/// @pre the folder is locked
/// Errors: as outdated_results and SweepResults::open; kIo.
[[nodiscard]] Status withdraw_outdated(const Sweep& sweep, const SweepOptions& options);

/// As fly_sweep, but flies only some of the sweep's cells and withdraws nothing.
[[nodiscard]] Result<FlownSweep> fly_cells(const Sweep& sweep,
                                           std::vector<SweepCell> cells,
                                           const SweepOptions& options);

/// Makes a folder a sweep without results, or changes what the next call flies into it.
/// Errors: kIo.
[[nodiscard]] Status write_sweep(const Sweep& sweep,
                                 const SweepPlan& plan,
                                 const std::filesystem::path& folder);
/// The sweep's document in a folder; its `scenario` is absolute.
/// Errors: as read_json; kUnreadable if it is no object.
[[nodiscard]] Result<nlohmann::json> read_sweep_document(const std::filesystem::path& folder);

/// Reads the results in a folder without flying.
/// Errors: as SweepPlan::make and SweepResults::read; kCancelled.
[[nodiscard]] Result<FlownSweep> read_sweep(const Sweep& sweep,
                                            const std::filesystem::path& folder,
                                            const std::atomic<bool>* cancel = nullptr);

}  // namespace overfly::server::experiments
