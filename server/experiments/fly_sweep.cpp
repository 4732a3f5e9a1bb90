#include "server/experiments/fly_sweep.hpp"

#include <algorithm>
#include <chrono>
#include <list>
#include <thread>
#include <utility>

#include "server/experiments/flight_files.hpp"
#include "server/experiments/flight_process.hpp"
#include "server/files/build_info.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_lock.hpp"
#include "server/runs/run_memory.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// A flight in the air.
struct Flying {
  DueFlight due;
  RunMemory memory;
  int attempts = 1;
};

class SweepFlyer {
 public:
  SweepFlyer(const Sweep& sweep, const SweepOptions& options, SweepPlan plan, SweepResults results)
      : sweep_(sweep),
        options_(options),
        processes_(options.program),
        files_(options.folder),
        flown_{std::move(plan), std::move(results), {}, false} {
    flown_.progress.most = flown_.plan.most_flights();
  }

  Result<FlownSweep> fly() {
    while (!cancelled()) {
      if (Status status = start_flights(); !status) return stopped(status.error());
      if (processes_.running() == 0) break;
      if (Status status = take_ended(); !status) return stopped(status.error());
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    processes_.stop();
    flown_.cancelled = cancelled();
    show();
    return std::move(flown_);
  }

 private:
  [[nodiscard]] bool cancelled() const { return options_.cancel != nullptr && *options_.cancel; }

  Error stopped(const Error& error) {
    processes_.stop();
    return error;
  }

  Status start_flights() {
    while (processes_.running() < options_.jobs && !cancelled()) {
      if (!waiting_) {
        Result<std::optional<DueFlight>> due = flown_.plan.next(flown_.results);
        if (!due) return due.error();
        waiting_ = std::move(*due);
        show();
      }
      if (!waiting_) return {};
      const RunMemory memory = memory_of(waiting_->scenario);
      if (Status status = budget_.check(waiting_->scenario); !status) return status;
      if (!has_memory(memory)) return {};
      DueFlight flight = std::move(*waiting_);
      waiting_.reset();
      if (Status status = begin({std::move(flight), memory, 1}); !status) return status;
    }
    return {};
  }

  [[nodiscard]] bool has_memory(RunMemory memory) const {
    for (const Flying& flying : flying_) memory += flying.memory;
    return flying_.empty() || budget_.holds(memory);
  }

  /// Takes over a flight that was completed before its results were written.
  Status begin(Flying flying) {
    const std::string id = flying.due.key;
    if (files_.is_completed(id)) {
      flying_.push_back(std::move(flying));
      return end({id, 0.0, false, ""});
    }
    if (Status status = launch(flying); !status) return status;
    flying_.push_back(std::move(flying));
    return {};
  }

  Status launch(const Flying& flying) {
    const DueFlight& due = flying.due;
    return files_.launch(processes_, due.key, due.scenario.resolved, sweep_.timeout_s);
  }

  Status take_ended() {
    while (const std::optional<EndedFlight> ended = processes_.ended()) {
      if (cancelled()) return {};
      if (Status status = end(*ended); !status) return status;
    }
    return {};
  }

  Status end(const EndedFlight& ended) {
    const auto flying = std::find_if(
        flying_.begin(), flying_.end(), [&](const Flying& f) { return f.due.key == ended.id; });
    flown_.progress.spent_s += ended.duration_s;
    std::string failure = files_.failure(ended, sweep_.timeout_s);
    RunMetrics metrics;
    if (failure.empty()) {
      Result<RunMetrics> read = read_run_metrics(files_.run(ended.id));
      if (read) metrics = std::move(*read);
      if (!read) failure = read.error().message;
    }
    if (!failure.empty() && flying->attempts <= sweep_.retries) {
      ++flying->attempts;
      warn(failure + "; flown again");
      return launch(*flying);
    }
    if (Status status = record(flying->due, ended, failure, metrics); !status) return status;
    ++flown_.progress.flown;
    if (!failure.empty()) {
      ++flown_.progress.failed;
      warn(cell_text(flown_.plan.cells()[flying->due.cell].values) + ": " + failure);
    }
    flown_.plan.over(flying->due);
    flying_.erase(flying);
    show();
    return {};
  }

  Status record(const DueFlight& due,
                const EndedFlight& ended,
                const std::string& failure,
                const RunMetrics& metrics) {
    for (std::size_t i = 0; i < due.keys.size(); ++i) {
      SweepResult result;
      result.key = due.keys[i];
      result.cell = flown_.plan.cells()[due.cell].values;
      result.repeat = due.repeat;
      result.seed = due.scenario.seed;
      result.estimator = due.scenario.estimators[i].name;
      result.run = "runs/" + due.key;
      result.duration_s = ended.duration_s;
      result.error = failure;
      const auto scored = metrics.estimators.find(result.estimator);
      if (failure.empty() && scored == metrics.estimators.end()) {
        result.error = "metrics.json: lacks estimator " + result.estimator;
      } else if (failure.empty()) {
        result.outcome = scored->second.score.outcome;
      }
      if (Status status = flown_.results.add(result); !status) return status;
    }
    return {};
  }

  void warn(const std::string& text) const {
    if (options_.warn) options_.warn(text);
  }

  void show() {
    SweepProgress& progress = flown_.progress;
    progress.passed = flown_.plan.passed_flights();
    if (progress.flown > 0) {
      const auto rest =
          static_cast<double>(progress.most - std::min(progress.passed, progress.most));
      const double each_s = progress.spent_s / static_cast<double>(progress.flown);
      progress.left_s =
          rest * each_s / static_cast<double>(std::max<std::size_t>(options_.jobs, 1));
    }
    if (options_.progress) options_.progress(progress);
  }

  const Sweep& sweep_;
  const SweepOptions& options_;
  const MemoryBudget budget_ = MemoryBudget::of_machine(false);
  FlightProcesses processes_;
  FlightFiles files_;
  FlownSweep flown_;
  std::list<Flying> flying_;
  std::optional<DueFlight> waiting_;  ///< for memory
};

/// The sweep as it was flown, for people and for programs that read its folder.
Json sweep_record(const Sweep& sweep, const SweepPlan& plan) {
  Json record = sweep.document;
  record["scenario"] = sweep.scenario_file.string();
  record["version"] = version() + " " + git_commit();
  record["estimator_names"] = plan.estimators();
  return record;
}

}  // namespace

Result<FlownSweep> fly_sweep(const Sweep& sweep, const SweepOptions& options) {
  Result<std::vector<SweepCell>> cells = cells_of(sweep);
  if (!cells) return cells.error();
  Result<SweepPlan> plan = SweepPlan::make(sweep, std::move(*cells));
  if (!plan) return plan.error();
  if (Status status = FlightFiles(options.folder).create(); !status) return status.error();
  const Result<RunLock> lock = RunLock::take(options.folder);
  if (!lock) return lock.error();
  Result<SweepResults> results = SweepResults::open(options.folder);
  if (!results) return results.error();
  if (results->unreadable_lines() > 0 && options.warn) {
    options.warn("results.jsonl: " + std::to_string(results->unreadable_lines()) +
                 " lines are no results and are ignored");
  }
  const fs::path record = options.folder / "sweep.json";
  if (Status status = write_json(record, sweep_record(sweep, *plan)); !status) {
    return status.error();
  }
  return SweepFlyer(sweep, options, std::move(*plan), std::move(*results)).fly();
}

Result<FlownSweep> read_sweep(const Sweep& sweep, const fs::path& folder) {
  Result<std::vector<SweepCell>> cells = cells_of(sweep);
  if (!cells) return cells.error();
  Result<SweepPlan> plan = SweepPlan::make(sweep, std::move(*cells));
  if (!plan) return plan.error();
  Result<SweepResults> results = SweepResults::read(folder);
  if (!results) return results.error();
  FlownSweep flown{std::move(*plan), std::move(*results), {}, false};
  flown.progress.most = flown.plan.most_flights();
  // Every flight that is due is passed over, so that the plan reaches all known repeats.
  for (;;) {
    Result<std::optional<DueFlight>> due = flown.plan.next(flown.results);
    if (!due) return due.error();
    if (!*due) break;
    ++flown.progress.flown;
    flown.plan.over(**due);
  }
  flown.progress.passed = flown.progress.most - std::min(flown.progress.flown, flown.progress.most);
  flown.progress.flown = 0;
  return flown;
}

}  // namespace overfly::server::experiments
