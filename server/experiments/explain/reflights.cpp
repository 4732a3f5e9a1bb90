#include "server/experiments/explain/reflights.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <thread>
#include <utility>

#include "core/cancel.hpp"
#include "server/experiments/flights/flight_files.hpp"
#include "server/experiments/keys/result_key.hpp"
#include "server/experiments/pictures/picture_key.hpp"
#include "server/runs/run_memory.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server::experiments {
namespace {

using Json = nlohmann::json;

/// As of the runs of sweeps.
constexpr std::size_t kIdLength = 20;

/// The errors of each pose are of no use here.
evaluation::Score without_poses(evaluation::Score score) {
  score.matched_t_ns.clear();
  for (auto& [mode, alignment] : score.alignments) {
    alignment.position_errors_m.clear();
    alignment.rotation_errors_deg.clear();
  }
  return score;
}

}  // namespace

struct Reflights::Prepared {
  Scenario scenario;
  std::string id;
  Reflight flight;
};

std::size_t Reflights::left() const {
  return options_.most_flights - std::min(options_.most_flights, flights_.size());
}

Result<Reflights::Prepared> Reflights::prepare(const Json& document,
                                               const CriticalPart& part,
                                               const PlannedReflight& planned) const {
  Json changed = document;
  for (const CauseChange& each : planned.changes) change(changed, each);
  if (planned.other_seed) changed["seed"] = changed.at("seed").get<std::uint64_t>() + 1;
  changed["title"] = document.value("title", "") + ", " + planned.name;
  Result<Scenario> scenario = resolve_scenario(std::move(changed), {}, "/", options_.sources);
  if (!scenario)
    return Error{scenario.error().code, planned.name + ": " + scenario.error().message};
  Prepared prepared;
  const Json& estimator = scenario->resolved.at("estimators").at(0);
  prepared.id = result_key(flight_key(*scenario), estimator).substr(0, kIdLength);
  prepared.flight.name = planned.name;
  prepared.flight.changes = planned.changes;
  prepared.flight.seed = scenario->seed;
  prepared.flight.part = part;
  prepared.flight.folder = FlightFiles(options_.folder).run(prepared.id);
  prepared.scenario = std::move(*scenario);
  return prepared;
}

Result<std::vector<const Reflight*>> Reflights::fly(const Json& document,
                                                    const CriticalPart& part,
                                                    const std::vector<PlannedReflight>& plan) {
  std::vector<Prepared> waiting;
  std::vector<std::filesystem::path> folders;
  for (const PlannedReflight& planned : plan) {
    Result<Prepared> prepared = prepare(document, part, planned);
    if (!prepared) return prepared.error();
    folders.push_back(prepared->flight.folder);
    const auto same = [&](const auto& flight) { return flight.folder == folders.back(); };
    const bool known = std::any_of(flights_.begin(), flights_.end(), same) ||
                       std::any_of(waiting.begin(), waiting.end(), [&](const Prepared& other) {
                         return same(other.flight);
                       });
    if (!known && waiting.size() < left()) waiting.push_back(std::move(*prepared));
  }
  if (Status status = fly_all(waiting); !status) {
    processes_.stop();
    return status.error();
  }
  std::vector<const Reflight*> flown;
  for (const std::filesystem::path& folder : folders) {
    const auto found = std::find_if(flights_.begin(), flights_.end(), [&](const Reflight& flight) {
      return flight.folder == folder;
    });
    flown.push_back(found == flights_.end() ? nullptr : &*found);
  }
  return flown;
}

Status Reflights::start(const Prepared& prepared) {
  if (options_.progress) options_.progress(flights_.size(), prepared.flight.name);
  // Most changes leave the pictures as they were. Others that no flight before had are probably not
  // needed again.
  const bool unchanged = prepared.flight.changes.empty();
  const bool is_new = known_pictures_.insert(picture_key(prepared.scenario)).second;
  return FlightFiles(options_.folder)
      .launch(processes_,
              prepared.id,
              prepared.scenario,
              options_.timeout_s,
              frame_cache_options(options_.frame_cache, unchanged || !is_new));
}

void Reflights::take_results(const Prepared& prepared, const std::string& failure) {
  Reflight flight = prepared.flight;
  flight.error = failure;
  const Result<RunMetrics> metrics = read_run_metrics(flight.folder);
  if (failure.empty() && !metrics) flight.error = metrics.error().message;
  if (flight.error.empty()) {
    const auto scored = metrics->estimators.find(prepared.scenario.estimators.front().name);
    if (scored == metrics->estimators.end()) {
      flight.error = "metrics.json lacks the estimator";
    } else {
      flight.score = without_poses(scored->second.score);
      flight.survived = survived(flight.score, flight.part);
      const CameraMetrics& seen = metrics->camera_of(scored->second);
      flight.texels_per_pixel_median = seen.texture.texels_per_pixel_median;
      flight.texture_limited = seen.texture.limited;
      flight.void_fraction_max = seen.void_fraction_max;
    }
  }
  flights_.push_back(std::move(flight));
  if (options_.progress) options_.progress(flights_.size(), flights_.back().name);
}

Status Reflights::fly_all(std::vector<Prepared>& planned) {
  const FlightFiles files(options_.folder);
  const MemoryBudget budget = MemoryBudget::of_machine(false);
  std::deque<Prepared*> waiting;
  for (Prepared& prepared : planned) {
    if (Status status = budget.check(prepared.scenario); !status) return status;
    if (files.is_completed(prepared.id)) {
      take_results(prepared, "");
    } else {
      waiting.push_back(&prepared);
    }
  }
  std::vector<Prepared*> flying;
  while (!waiting.empty() || !flying.empty()) {
    if (is_cancelled(options_.cancel)) {
      return Error{ErrorCode::kCancelled, "cancelled; the same command continues"};
    }
    while (!waiting.empty() && flying.size() < options_.jobs) {
      RunMemory memory = memory_of(waiting.front()->scenario);
      for (const Prepared* other : flying) memory += memory_of(other->scenario);
      if (!flying.empty() && !budget.holds(memory)) break;
      if (Status status = start(*waiting.front()); !status) return status;
      flying.push_back(waiting.front());
      waiting.pop_front();
    }
    while (const std::optional<EndedFlight> ended = *processes_.ended()) {
      if (is_cancelled(options_.cancel)) break;
      const auto which = std::find_if(flying.begin(), flying.end(), [&](const Prepared* prepared) {
        return prepared->id == ended->id;
      });
      take_results(**which, files.failure(*ended, options_.timeout_s));
      flying.erase(which);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return {};
}

}  // namespace overfly::server::experiments
