// Sweeps that clients of a server ask for: checked as the scenario of a run is.
#pragma once

#include <atomic>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/experiments/sweep_plan.hpp"
#include "server/runs/run_manager.hpp"

namespace overfly::server::experiments {

/// Why a sweep is not flown, in addition to the error.
enum class SweepRefusal {
  kNone,
  kOff,     ///< the server has no folder of sweeps
  kMemory,  ///< a flight needs more memory than there is
  kBusy,    ///< another sweep flies
};

/// A sweep that the server may fly.
struct ClientSweep {
  std::shared_ptr<const Sweep> sweep;
  SweepPlan plan;                           ///< of that sweep
  std::vector<std::string> flight_options;  ///< SweepOptions::flight_options
};

/// Checks a document and the scenario of each of its cells: files must lie in the data folders,
/// commands and addresses must be those of the owner's scenarios, or the sweep must be one of the
/// owner's sweep files. `scenario` is a scenario's name, or a file relative to the folder of the
/// sweep files.
/// @param runs  must outlive the result
/// Errors: as resolve_sweep, cells_of and SweepPlan::make, with `refusal`.
[[nodiscard]] Result<ClientSweep> read_client_sweep(RunManager& runs,
                                                    nlohmann::json document,
                                                    SweepRefusal& refusal,
                                                    const std::atomic<bool>* cancel);

}  // namespace overfly::server::experiments
