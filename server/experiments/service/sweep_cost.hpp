// What a sweep costs, known before it is flown.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/experiments/sweep_plan.hpp"

namespace overfly::server::experiments {

struct SweepCost {
  std::size_t cells = 0;
  std::vector<std::string> estimators;
  /// Along which the border of survival can be sought: name and label.
  std::vector<std::pair<std::string, std::string>> border_axes;
  std::size_t flights = 0;         ///< at most
  std::optional<double> flight_s;  ///< mean of one, by the clock on the wall; empty if not known
};

/// The duration is that of earlier flights of the same scenario with the same `set` and
/// `estimators`, in the sweep of the folder that was flown last.
/// @param sweeps_folder  may be absent
[[nodiscard]] SweepCost sweep_cost(const Sweep& sweep,
                                   const SweepPlan& plan,
                                   const std::filesystem::path& sweeps_folder);

}  // namespace overfly::server::experiments
