#include "server/experiments/outdated_results.hpp"

#include <map>
#include <string>
#include <utility>

#include "core/cancel.hpp"
#include "server/experiments/keys/plain_numbers.hpp"
#include "server/experiments/keys/result_key.hpp"

namespace overfly::server::experiments {
namespace {

using Json = nlohmann::json;

/// Estimator -> its key in a flight.
std::map<std::string, std::string> keys_of(const Scenario& scenario) {
  const std::string flight = flight_key(scenario);
  std::map<std::string, std::string> keys;
  for (std::size_t i = 0; i < scenario.estimators.size(); ++i) {
    keys[scenario.estimators[i].name] =
        result_key(flight, scenario.resolved.at("estimators").at(i));
  }
  return keys;
}

}  // namespace

Result<std::vector<SweepResult>> outdated_results(const Sweep& sweep,
                                                  const SweepResults& results,
                                                  const std::atomic<bool>* cancel) {
  std::vector<SweepResult> outdated;
  // Cell as text, repeat -> results
  std::map<std::pair<std::string, int>, std::vector<const SweepResult*>> flights;
  for (const SweepResult* result : results.newest()) {
    flights[{result->cell.dump(), result->repeat}].push_back(result);
  }
  if (flights.empty()) return outdated;
  const Result<std::vector<SweepCell>> cells = cells_of(sweep);
  if (!cells) return cells.error();
  std::map<std::string, const SweepCell*> by_text;
  for (const SweepCell& cell : *cells) by_text[with_plain_numbers(cell.values).dump()] = &cell;
  for (const auto& [flight, flown] : flights) {
    if (is_cancelled(cancel)) return Error{ErrorCode::kCancelled, "cancelled"};
    const auto& [text, repeat] = flight;
    const auto cell = by_text.find(text);
    if (cell == by_text.end() || repeat < 0 || repeat >= sweep.repeats.most) continue;
    const Result<Scenario> scenario = scenario_of(sweep, *cell->second, repeat);
    if (!scenario) continue;
    const std::map<std::string, std::string> keys = keys_of(*scenario);
    for (const SweepResult* result : flown) {
      const auto key = keys.find(result->estimator);
      if (key != keys.end() && key->second != result->key) outdated.push_back(*result);
    }
  }
  return outdated;
}

}  // namespace overfly::server::experiments
