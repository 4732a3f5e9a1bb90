#include "server/experiments/service/sweep_cost.hpp"

#include <algorithm>
#include <string>

#include "server/experiments/envelope/envelope.hpp"
#include "server/experiments/fly_sweep.hpp"
#include "server/experiments/sweep_folders.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Whether the flights of two sweeps last about as long.
bool fly_alike(const Json& recorded, const Sweep& sweep) {
  const auto same = [&](const char* name) {
    return recorded.value(name, Json()) == sweep.document.value(name, Json());
  };
  return recorded.value("scenario", Json()) == sweep.scenario_file.string() && same("set") &&
         same("estimators");
}

/// Each flight has a result for each of its estimators, with the duration of the flight.
std::optional<double> mean_duration_s(const fs::path& folder) {
  const Result<SweepResults> results = SweepResults::read(folder);
  if (!results) return std::nullopt;
  double sum_s = 0.0;
  std::size_t count = 0;
  for (const auto& [key, result] : results->by_key()) {
    // A flight that was taken over from its folder has no duration.
    if (!result.completed() || result.duration_s <= 0.0) continue;
    sum_s += result.duration_s;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum_s / static_cast<double>(count);
}

std::optional<double> known_duration_s(const Sweep& sweep, const fs::path& sweeps_folder) {
  const Json list = sweep_list(sweeps_folder);
  for (const Json& entry : list.at("sweeps")) {
    const fs::path folder = sweeps_folder / entry.at("name").get<std::string>();
    const Result<Json> recorded = read_sweep_document(folder);
    if (!recorded || !fly_alike(*recorded, sweep)) continue;
    if (const auto duration_s = mean_duration_s(folder)) return duration_s;
  }
  return std::nullopt;
}

}  // namespace

SweepCost sweep_cost(const Sweep& sweep, const SweepPlan& plan, const fs::path& sweeps_folder) {
  std::vector<std::pair<std::string, std::string>> axes;
  for (const SweepAxis* axis : border_axes(sweep)) axes.emplace_back(axis->name, axis->label);
  return {plan.cells().size(),
          plan.estimators(),
          std::move(axes),
          plan.most_flights(),
          known_duration_s(sweep, sweeps_folder)};
}

}  // namespace overfly::server::experiments
