#include "server/experiments/explain/critical_part.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "server/experiments/explain/fault_places.hpp"

namespace overfly::server::experiments {
namespace {

using Json = nlohmann::json;
using evaluation::Outcome;

constexpr double kAfter_s = 6.0;  // enough to see a loss or a reset
constexpr double kShortestFlight_s = 1.0;

/// As in evaluation::Outcome, INIT_LATE.
double latest_start_s(double duration_s) { return std::min(10.0, std::max(2.0, duration_s / 10)); }

CriticalPart beginning(double duration_s) {
  const double latest_s = latest_start_s(duration_s);
  return {0.0, std::min(duration_s, latest_s + 2 * kAfter_s), latest_s};
}

Json part_faults(const Json& document, const CriticalPart& part) {
  Json faults = Json::array();
  for (Json fault : document.value("faults", Json::array())) {
    const double at_s = fault.at("at_s").get<double>() - part.from_s;
    const bool ends = fault.contains("duration_s");
    const double end_s = ends ? at_s + fault.at("duration_s").get<double>() : part.to_s;
    if (ends && end_s <= 0.0) {
      move_out_of_flight(fault);
    } else {
      fault["at_s"] = std::max(0.0, at_s);
      if (ends) fault["duration_s"] = end_s - std::max(0.0, at_s);
    }
    faults.push_back(fault);
  }
  return faults;
}

}  // namespace

std::vector<CriticalPart> critical_parts(const evaluation::Score& score, double duration_s) {
  if (failed_to_start(score.outcome)) return {beginning(duration_s)};
  if (!score.outcome_time_s) return {{0.0, duration_s, latest_start_s(duration_s)}};
  const double instant_s = *score.outcome_time_s;
  const double to_s = std::min(duration_s, instant_s + kAfter_s);
  std::vector<double> before_s = {10.0, 30.0};
  if (score.outcome == Outcome::kDiverged) before_s = {40.0};
  std::vector<CriticalPart> parts;
  for (const double before : before_s) {
    // Whole seconds: exact in any text.
    const double from_s = std::floor(instant_s - before);
    if (from_s > 0.0) parts.push_back({from_s, to_s, instant_s - from_s - 1.0});
  }
  const double latest_s =
      std::max(latest_start_s(duration_s), score.initialised_at_s.value_or(0.0));
  parts.push_back({0.0, std::max(to_s, std::min(duration_s, kShortestFlight_s)), latest_s});
  // Several losses may add up to LOST, of which the part has only the first.
  if (score.outcome == Outcome::kLost && to_s < duration_s) {
    parts.push_back({0.0, duration_s, latest_s});
  }
  return parts;
}

bool failed_to_start(Outcome outcome) {
  return outcome == Outcome::kNotInitialised || outcome == Outcome::kInitLate;
}

bool survived(const evaluation::Score& score, const CriticalPart& part) {
  if (score.outcome == Outcome::kCompleted) return true;
  return score.outcome == Outcome::kInitLate && score.initialised_at_s &&
         *score.initialised_at_s <= part.latest_start_s;
}

Json part_document(const Json& document,
                   const std::filesystem::path& run_folder,
                   std::size_t estimator,
                   const CriticalPart& part) {
  Json made = document;
  const Json kept = document.at("estimators").at(estimator);
  made["estimators"] = Json::array({kept});
  double start_s = document.value("start_s", 0.0);
  const Json& flight = document.at("flight");
  if (!flight.contains("course") && !flight.contains("mission")) {
    made["flight"] = {{"run", {{"folder", run_folder.string()}}}};
    start_s = 0.0;
  }
  made["start_s"] = start_s + part.from_s;
  made["duration_s"] = part.to_s - part.from_s;
  made["faults"] = part_faults(document, part);
  remove_last_out_of_flight(made, made["faults"]);
  made["recording"] = {{"frames", false}, {"debug_hz", 0}};
  return made;
}

}  // namespace overfly::server::experiments
