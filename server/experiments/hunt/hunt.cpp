#include "server/experiments/hunt/hunt.hpp"

#include <algorithm>
#include <cstdio>
#include <set>
#include <string>
#include <utility>

#include "core/cancel.hpp"
#include "server/experiments/pictures/picture_key.hpp"

namespace overfly::server::experiments {
namespace {

class Hunter {
 public:
  Hunter(const Hunt& hunt, const HuntOptions& options)
      : hunt_(hunt),
        options_(options),
        sweep_(hunt.sweep),
        search_(search_axes(hunt), hunt.method, hunt.seed) {
    sweep_.chosen_cells.emplace();
  }

  Result<HuntResult> hunt() {
    const auto repeats = static_cast<std::size_t>(sweep_.repeats.most);
    for (;;) {
      if (options_.progress) options_.progress(result_);
      result_.cancelled = is_cancelled(options_.flights.cancel);
      const std::size_t left = (hunt_.most_flights - result_.flights.size()) / repeats;
      const bool found = hunt_.stop_at_failure && result_.flights_to_failure();
      if (result_.cancelled || found || left == 0) break;
      const auto points = search_.next(std::min(hunt_.batch, left));
      result_.exhausted = points.empty();
      if (points.empty()) break;
      if (Status status = fly(points); !status) return status.error();
      if (result_.cancelled) break;
    }
    return std::move(result_);
  }

 private:
  Status fly(const std::vector<Eigen::VectorXd>& points) {
    std::vector<SweepCell> cells;
    for (const Eigen::VectorXd& point : points) cells.push_back(cell_at(hunt_, point));
    SweepOptions flights = options_.flights;
    flights.pictures_recur = note_pictures(cells);
    sweep_.chosen_cells->insert(sweep_.chosen_cells->end(), cells.begin(), cells.end());
    const Result<FlownSweep> flown = fly_cells(sweep_, std::move(cells), flights);
    const bool is_stopped = !flown && flown.error().code == ErrorCode::kCancelled;
    if (!flown && !is_stopped) return flown.error();
    result_.cancelled = is_stopped || flown->cancelled;
    if (result_.cancelled) return {};
    std::vector<double> values;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Result<double> lowest = take_flights(*flown, i);
      if (!lowest) return lowest.error();
      values.push_back(*lowest);
    }
    search_.tell(values);
    return {};
  }

  /// @return whether cells have the same pictures as earlier ones: limits on the sensor's noise,
  /// the estimator or other things that do not change them
  bool note_pictures(const std::vector<SweepCell>& cells) {
    if (options_.flights.frame_cache.budget_gib <= 0.0) return false;
    bool recur = false;
    for (const SweepCell& cell : cells) {
      const Result<Scenario> scenario = scenario_of(sweep_, cell, 0);
      if (scenario) recur |= !known_pictures_.insert(picture_key(*scenario)).second;
    }
    return recur;
  }

  /// @return the lowest margin of the cell's flights
  Result<double> take_flights(const FlownSweep& flown, std::size_t cell) {
    double lowest = 1.0;
    int repeat = 0;
    for (const SweepResult* flight : flown.plan.results_of(cell, hunt_.estimator, flown.results)) {
      const SweepCell& flown_cell = flown.plan.cells()[cell];
      if (!flight->completed()) {
        return Error{ErrorCode::kInternal, cell_text(flown_cell.values) + ": " + flight->error};
      }
      const Result<FlightEvidence> evidence =
          read_evidence(options_.flights.folder / flight->run, hunt_.estimator);
      if (!evidence) return evidence.error();
      HuntedFlight hunted{flown_cell,
                          repeat++,  // a flight that cells share has that of another cell
                          flight->seed,
                          flight->run,
                          flight->outcome,
                          margin_of(*evidence, hunt_.rule)};
      lowest = std::min(lowest, hunted.margin.value);
      result_.flights.push_back(std::move(hunted));
    }
    return lowest;
  }

  const Hunt& hunt_;
  const HuntOptions& options_;
  Sweep sweep_;
  PointSearch search_;
  HuntResult result_;
  std::set<std::string> known_pictures_;  ///< picture_key of the cells so far
};

}  // namespace

const HuntedFlight* HuntResult::worst() const {
  const auto lowest = std::min_element(
      flights.begin(), flights.end(), [](const HuntedFlight& a, const HuntedFlight& b) {
        return a.margin.value < b.margin.value;
      });
  return lowest == flights.end() ? nullptr : &*lowest;
}

std::optional<std::size_t> HuntResult::flights_to_failure() const {
  const auto first = std::find_if(flights.begin(), flights.end(), [](const HuntedFlight& flight) {
    return flight.margin.failed;
  });
  if (first == flights.end()) return std::nullopt;
  return static_cast<std::size_t>(first - flights.begin()) + 1;
}

Result<HuntResult> fly_hunt(const Hunt& hunt, const HuntOptions& options) {
  const Result<RunLock> lock = lock_sweep(options.flights.folder);
  if (!lock) return lock.error();
  HuntOptions locked = options;
  locked.flights.lock = &*lock;
  return Hunter(hunt, locked).hunt();
}

std::string result_text(const HuntedFlight& flight) {
  if (flight.margin.failed) return "fails: " + flight.margin.failure;
  char text[48];
  std::snprintf(text, sizeof text, "survives with margin %.3f", flight.margin.value);
  return text;
}

Result<nlohmann::json> scenario_document(const Hunt& hunt, const HuntedFlight& flight) {
  const Result<Scenario> scenario = scenario_of(hunt.sweep, flight.cell, flight.repeat);
  if (!scenario) return scenario.error();
  nlohmann::json document = scenario->resolved;
  document["title"] = "The worst flight found " + result_text(flight);
  return document;
}

}  // namespace overfly::server::experiments
