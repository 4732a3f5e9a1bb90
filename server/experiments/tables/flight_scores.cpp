#include "server/experiments/tables/flight_scores.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "core/cancel.hpp"
#include "server/experiments/sweep_document.hpp"
#include "server/experiments/sweep_extent.hpp"
#include "server/experiments/sweep_results.hpp"
#include "server/files/whole_file.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string text_or(const Json& object, const char* name, const std::string& otherwise) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? found->get<std::string>() : otherwise;
}

std::vector<ShownAxis> axes_of(const Json& sweep) {
  std::vector<ShownAxis> axes;
  const auto found = sweep.find("axes");
  if (found == sweep.end() || !found->is_array()) return axes;
  for (const Json& axis : *found) {
    if (!axis.is_object()) continue;
    const std::string name = text_or(axis, "path", text_or(axis, "name", ""));
    axes.push_back({name, text_or(axis, "label", name), text_or(axis, "unit", "")});
  }
  return axes;
}

/// Runs are read once, whatever the number of their estimators.
class RunReader {
 public:
  explicit RunReader(const fs::path& folder) : folder_(folder) {}

  /// Null if the metrics cannot be read.
  const RunMetrics* read(const std::string& run, std::vector<std::string>& problems) {
    const auto found = runs_.find(run);
    if (found != runs_.end()) return found->second ? &*found->second : nullptr;
    Result<RunMetrics> metrics = read_run_metrics(folder_ / run);
    std::optional<RunMetrics>& kept = runs_[run];
    if (!metrics) {
      problems.push_back(metrics.error().message);
      return nullptr;
    }
    kept = std::move(*metrics);
    return &*kept;
  }

 private:
  fs::path folder_;
  std::map<std::string, std::optional<RunMetrics>> runs_;
};

void add_flight(const SweepResult& result, RunReader& runs, SweepScores& scores) {
  const RunMetrics* metrics = runs.read(result.run, scores.problems);
  if (metrics == nullptr) return;
  const auto estimator = metrics->estimators.find(result.estimator);
  if (estimator == metrics->estimators.end()) {
    scores.problems.push_back(result.run + ": has no estimator " + result.estimator);
    return;
  }
  FlightScore flight;
  flight.cell = result.cell;
  flight.repeat = result.repeat;
  flight.estimator = result.estimator;
  flight.type = estimator->second.type;
  flight.run = result.run;
  flight.path_length_m = metrics->flight.path_length_m;
  flight.texture_limited = metrics->camera_of(estimator->second).texture.limited;
  flight.outcome = result.outcome;
  flight.score = estimator->second.score;
  const auto& names = scores.estimators;
  if (std::find(names.begin(), names.end(), flight.estimator) == names.end()) {
    scores.estimators.push_back(flight.estimator);
  }
  scores.flights.push_back(std::move(flight));
}

/// Axis -> its values that are texts, in the sweep's order.
using TextOrder = std::map<std::string, std::vector<std::string>>;

TextOrder text_order_of(const Json& sweep) {
  TextOrder order;
  const auto found = sweep.find("axis_values");
  if (found == sweep.end() || !found->is_object()) return order;
  for (const auto& [axis, values] : found->items()) {
    for (const Json& value : values) {
      if (value.is_string()) order[axis].push_back(value.get<std::string>());
    }
  }
  return order;
}

bool comes_before(const Json& a, const Json& b, const std::vector<std::string>& texts) {
  if (!a.is_string() || !b.is_string()) return a < b;
  const auto place_of = [&](const Json& value) {
    return std::find(texts.begin(), texts.end(), value.get_ref<const std::string&>());
  };
  const auto place_a = place_of(a);
  const auto place_b = place_of(b);
  return place_a != place_b ? place_a < place_b : a < b;
}

std::vector<Json> sorted_cells(const SweepScores& scores, const TextOrder& order) {
  std::vector<Json> cells;
  for (const FlightScore& flight : scores.flights) cells.push_back(flight.cell);
  const auto before = [&](const Json& a, const Json& b) {
    for (const ShownAxis& axis : scores.axes) {
      const Json left = a.value(axis.name, Json());
      const Json right = b.value(axis.name, Json());
      if (left == right) continue;
      const auto texts = order.find(axis.name);
      return texts == order.end() ? left < right : comes_before(left, right, texts->second);
    }
    return a < b;
  };
  std::sort(cells.begin(), cells.end(), before);
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

}  // namespace

Result<SweepScores> read_sweep_scores(const fs::path& folder, const std::atomic<bool>* cancel) {
  const Result<Json> sweep = read_json(folder / "sweep.json", kMaxSweepBytes);
  if (!sweep) return sweep.error();
  const Result<SweepResults> results = SweepResults::read(folder);
  if (!results) return results.error();
  SweepScores scores;
  if (sweep->is_object()) {
    scores.title = text_or(*sweep, "title", "");
    scores.version = text_or(*sweep, "version", "");
    scores.axes = axes_of(*sweep);
  }
  const SweepExtent extent(*sweep);
  scores.estimators = extent.estimators();
  RunReader runs(folder);
  for (const SweepResult* result : results->newest()) {
    if (is_cancelled(cancel)) return Error{ErrorCode::kCancelled, "cancelled"};
    if (!result->cell.is_object()) continue;
    if (!extent.contains(*result)) {
      ++scores.former_results;
      continue;
    }
    if (result->completed()) {
      add_flight(*result, runs, scores);
    } else {
      ++scores.failed;
    }
  }
  if (scores.flights.empty()) {
    return Error{ErrorCode::kNotFound, folder.string() + ": has no completed flight"};
  }
  scores.cells = sorted_cells(scores, text_order_of(*sweep));
  return scores;
}

}  // namespace overfly::server::experiments
