// Results of a sweep whose flight has changed since.
#pragma once

#include <atomic>
#include <vector>

#include "server/experiments/sweep_document.hpp"
#include "server/experiments/sweep_results.hpp"

namespace overfly::server::experiments {

/// The newest results whose cell, repeat and estimator have another key by now: the program, the
/// estimator, a file or a field of the sweep was changed. Tables would mix them with the new ones
/// until all are flown. Results of cells and estimators that the sweep does not have are left out
/// (SweepExtent), and so are those of cells without a valid scenario.
/// Errors: as cells_of; kCancelled.
[[nodiscard]] Result<std::vector<SweepResult>> outdated_results(const Sweep& sweep,
                                                                const SweepResults& results,
                                                                const std::atomic<bool>* cancel);

}  // namespace overfly::server::experiments
