#include "server/experiments/fly_sweep.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "core/cancel.hpp"
#include "server/experiments/flights/flight_files.hpp"
#include "server/experiments/flights/flight_process.hpp"
#include "server/experiments/keys/plain_numbers.hpp"
#include "server/experiments/outdated_results.hpp"
#include "server/files/build_info.hpp"
#include "server/files/whole_file.hpp"
#include "server/runs/run_memory.hpp"
#include "server/scoring/metrics.hpp"
#include "server/scoring/run_metrics_json.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// A flight in the air.
struct Flying {
  DueFlight due;
  RunMemory memory;
  std::shared_ptr<const void> held;  ///< its part of SweepOptions::hold_memory
  int attempts = 1;
};

std::string flight_text(const Json& cell, int repeat) {
  return with_plain_numbers(cell).dump() + " " + std::to_string(repeat);
}

/// Why an estimator has no result of a completed flight; empty if it has.
std::string lack_of_result(const std::string& estimator, const RunMetrics& metrics) {
  if (!metrics.estimators.contains(estimator)) return "metrics.json: lacks estimator " + estimator;
  const std::map<std::string, std::string> reasons = never_ran(metrics);
  const auto reason = reasons.find(estimator);
  return reason == reasons.end() ? "" : never_ran_text(estimator, reason->second);
}

class SweepFlyer {
 public:
  SweepFlyer(const Sweep& sweep,
             const SweepOptions& options,
             std::unique_ptr<FlightExecutor> executor,
             SweepPlan plan,
             SweepResults results)
      : sweep_(sweep),
        options_(options),
        executor_(std::move(executor)),
        files_(options.folder),
        flown_{std::move(plan), std::move(results), {}, false, {}} {
    flown_.progress.most = flown_.plan.most_flights();
    std::map<std::string, double> earlier_s;  // a flight's results share its run
    for (const auto& [key, result] : flown_.results.by_key()) {
      if (result.completed()) flown_before_.insert(flight_text(result.cell, result.repeat));
      earlier_s[result.run] = result.duration_s;
    }
    for (const auto& [run, duration_s] : earlier_s) flown_.progress.spent_s += duration_s;
  }

  Result<FlownSweep> fly() {
    while (!cancelled()) {
      if (Status status = start_flights(); !status) return stopped(status.error());
      most_at_once_ = std::max(most_at_once_, executor_->flying());
      if (executor_->running() == 0 && !waiting_) break;
      if (Status status = take_ended(); !status) return stopped(status.error());
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    executor_->stop();
    flown_.cancelled = cancelled();
    if (Status status = withdraw_surplus(); !status) return status.error();
    show();
    return std::move(flown_);
  }

 private:
  [[nodiscard]] bool cancelled() const { return options_.cancel != nullptr && *options_.cancel; }

  Error stopped(const Error& error) {
    executor_->stop();
    return error;
  }

  Status start_flights() {
    while (executor_->running() < options_.jobs && !cancelled()) {
      if (!waiting_) {
        Result<std::optional<DueFlight>> due = flown_.plan.next(flown_.results, options_.cancel);
        if (!due) return due.error();
        waiting_ = std::move(*due);
        if (Status status = record_shared(); !status) return status;
        if (waiting_ || flown_.plan.passed_flights() != flown_.progress.passed) show();
      }
      if (!waiting_) return {};
      const RunMemory memory = memory_of(waiting_->scenario);
      std::shared_ptr<const void> held;
      if (options_.open_executor) {
        // Its workers know their machines' memory.
      } else if (options_.hold_memory) {
        held = options_.hold_memory(memory);
        if (!held) return {};
      } else {
        if (Status fits = budget_.check(waiting_->scenario); !fits) return fits;
        if (!has_memory(memory)) return {};
      }
      DueFlight flight = std::move(*waiting_);
      waiting_.reset();
      Flying flying{std::move(flight), memory, std::move(held), 1};
      if (Status status = begin(std::move(flying)); !status) return status;
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
    return files_.launch(
        *executor_, due.key, due.scenario, sweep_.timeout_s, cache_options(flying));
  }

  /// A flight that other estimators have flown before is likely to be flown by more.
  [[nodiscard]] std::vector<std::string> cache_options(const Flying& flying) const {
    const DueFlight& due = flying.due;
    if (options_.open_executor || options_.frame_cache.budget_gib <= 0.0) return {};
    const SweepCell& cell = flown_.plan.cells()[due.cell];
    return frame_cache_options(options_.frame_cache,
                               options_.pictures_recur ||
                                   flown_before_.contains(flight_text(cell.values, due.repeat)) ||
                                   flown_.plan.shares_pictures(due));
  }

  void count_pictures_of(const EndedFlight& ended) {
    if (options_.open_executor || options_.frame_cache.budget_gib <= 0.0) return;
    const bool known = !flown_.pictures.problem.empty();
    count_pictures(files_.run(ended.id), flown_.pictures);
    if (!known && !flown_.pictures.problem.empty()) {
      warn("frame cache: " + flown_.pictures.problem);
    }
  }

  Status take_ended() {
    for (;;) {
      const Result<std::optional<EndedFlight>> ended = executor_->ended();
      if (!ended) return ended.error();
      if (!*ended || cancelled()) return {};
      if (Status status = end(**ended); !status) return status;
    }
  }

  Status end(const EndedFlight& ended) {
    const auto flying = std::find_if(
        flying_.begin(), flying_.end(), [&](const Flying& f) { return f.due.key == ended.id; });
    flown_.progress.spent_s += ended.duration_s;
    own_s_ += ended.duration_s;
    count_pictures_of(ended);
    std::string failure = files_.failure(ended, sweep_.timeout_s);
    RunMetrics metrics;
    if (failure.empty()) {
      Result<RunMetrics> read = read_run_metrics(files_.run(ended.id));
      if (read) metrics = std::move(*read);
      if (!read) failure = read.error().message;
    }
    // Estimators that did not start would not start now either.
    if (!failure.empty() && flying->attempts <= sweep_.retries &&
        failure != files_.none_ran(ended.id)) {
      ++flying->attempts;
      warn(failure + "; flown again");
      return launch(*flying);
    }
    const Result<std::string> problem = record(flying->due, ended, failure, metrics);
    if (!problem) return problem.error();
    ++flown_.progress.flown;
    if (!problem->empty()) {
      ++flown_.progress.failed;
      const std::string cell = cell_text(flown_.plan.cells()[flying->due.cell].values);
      warn((cell.empty() ? "" : cell + ": ") + *problem);
    }
    flown_.plan.over(flying->due);
    flying_.erase(flying);
    show();
    return {};
  }

  /// @param failure  of the whole flight; empty if it has results
  /// @return why estimators have no result; empty if all have one
  Result<std::string> record(const DueFlight& due,
                             const EndedFlight& ended,
                             const std::string& failure,
                             const RunMetrics& metrics) {
    std::string problems = failure;
    for (std::size_t i = 0; i < due.keys.size(); ++i) {
      SweepResult result;
      result.key = due.keys[i];
      result.cell = flown_.plan.cells()[due.cell].values;
      result.repeat = due.repeat;
      result.seed = due.scenario.seed;
      result.estimator = due.scenario.estimators[i].name;
      result.run = "runs/" + due.key;
      result.duration_s = ended.duration_s;
      result.error = failure.empty() ? lack_of_result(result.estimator, metrics) : failure;
      if (result.completed()) {
        result.outcome = metrics.estimators.at(result.estimator).score.outcome;
      } else if (failure.empty()) {
        problems += (problems.empty() ? "" : "; ") + result.error;
      }
      if (Status status = flown_.results.add(result); !status) return status.error();
    }
    return problems;
  }

  /// Cells and repeats that have the flight of another one get a line each.
  Status record_shared() {
    for (const SweepResult& result : flown_.plan.take_shared(flown_.results)) {
      if (Status status = flown_.results.add(result); !status) return status;
    }
    return {};
  }

  Status withdraw_surplus() {
    for (const SweepResult& result : flown_.plan.surplus(flown_.results)) {
      if (Status status = flown_.results.withdraw(result); !status) return status;
    }
    return {};
  }

  void warn(const std::string& text) const {
    if (options_.warn) options_.warn(text);
  }

  void show() {
    SweepProgress& progress = flown_.progress;
    progress.passed = flown_.plan.passed_flights();
    const auto rest = static_cast<double>(progress.most - std::min(progress.passed, progress.most));
    if (rest == 0.0) {
      progress.left_s = 0.0;
    } else if (progress.flown > 0) {
      const double each_s = own_s_ / static_cast<double>(progress.flown);
      progress.left_s = rest * each_s / static_cast<double>(most_at_once_);
    }
    if (options_.progress) options_.progress(progress);
    // For those who watch the folder; a full disk is noticed where results are written.
    if (options_.writes_progress) (void)write_progress(options_.folder, progress);
  }

  const Sweep& sweep_;
  const SweepOptions& options_;
  const MemoryBudget budget_ = MemoryBudget::of_machine(false);
  std::unique_ptr<FlightExecutor> executor_;
  FlightFiles files_;
  FlownSweep flown_;
  std::set<std::string> flown_before_;  ///< cells and repeats with results of an earlier call
  std::list<Flying> flying_;
  std::optional<DueFlight> waiting_;  ///< for memory
  double own_s_ = 0.0;                ///< of the flights of this call
  std::size_t most_at_once_ = 1;      ///< flights that flew at the same time so far
};

/// What sweep.json has in addition to the sweep's document.
constexpr std::array<const char*, 3> kRecorded{"version", "estimator_names", "axis_values"};

/// The sweep as it was flown, for people and for programs that read its folder.
Result<Json> sweep_record(const Sweep& sweep, const SweepPlan& plan) {
  const Result<std::vector<SweepCell>> cells = cells_of(sweep);
  if (!cells) return cells.error();
  Json record = sweep.document;
  record["scenario"] = sweep.scenario_file.string();
  record["version"] = version() + " " + git_commit();
  record["estimator_names"] = plan.estimators();
  Json& values = record["axis_values"] = Json::object();
  for (const SweepAxis& axis : sweep.axes) values[axis.name] = Json::array();
  for (const SweepCell& cell : *cells) {
    for (const auto& [name, value] : cell.values.items()) {
      Json& known = values[name];
      if (std::find(known.begin(), known.end(), value) == known.end()) known.push_back(value);
    }
  }
  return record;
}

/// @pre the sweep's folder is locked
Result<FlownSweep> fly_plan(const Sweep& sweep, SweepPlan plan, const SweepOptions& options) {
  Result<SweepResults> results = SweepResults::open(options.folder);
  if (!results) return results.error();
  if (results->unreadable_lines() > 0 && options.warn) {
    options.warn("results.jsonl: " + std::to_string(results->unreadable_lines()) +
                 " lines are no results and are ignored");
  }
  if (Status status = write_sweep(sweep, plan, options.folder); !status) return status.error();
  std::unique_ptr<FlightExecutor> executor;
  if (options.open_executor) {
    Result<std::unique_ptr<FlightExecutor>> opened = options.open_executor();
    if (!opened) return opened.error();
    executor = std::move(*opened);
  } else {
    executor = std::make_unique<FlightProcesses>(options.program, options.flight_options);
  }
  return SweepFlyer(sweep, options, std::move(executor), std::move(plan), std::move(*results))
      .fly();
}

}  // namespace

Result<RunLock> lock_sweep(const fs::path& folder) {
  if (Status status = FlightFiles(folder).create(); !status) return status.error();
  return RunLock::take(folder);
}

Status withdraw_outdated(const Sweep& sweep, const SweepOptions& options) {
  Result<SweepResults> results = SweepResults::open(options.folder);
  if (!results) return results.error();
  const Result<std::vector<SweepResult>> outdated =
      outdated_results(sweep, *results, options.cancel);
  if (!outdated) return outdated.error();
  for (const SweepResult& result : *outdated) {
    if (Status status = results->withdraw(result); !status) return status;
  }
  return {};
}

Result<FlownSweep> fly_sweep(const Sweep& sweep, const SweepOptions& options) {
  Result<std::vector<SweepCell>> cells = cells_of(sweep);
  if (!cells) return cells.error();
  // A sweep with an invalid cell changes no result.
  Result<SweepPlan> plan = SweepPlan::make(sweep, std::move(*cells), options.cancel);
  if (!plan) return plan.error();
  SweepOptions locked = options;
  std::optional<RunLock> own;
  if (options.lock == nullptr) {
    Result<RunLock> lock = lock_sweep(options.folder);
    if (!lock) return lock.error();
    locked.lock = &own.emplace(std::move(*lock));
  }
  if (Status status = withdraw_outdated(sweep, locked); !status) return status.error();
  return fly_plan(sweep, std::move(*plan), locked);
}

Status write_sweep(const Sweep& sweep, const SweepPlan& plan, const fs::path& folder) {
  if (Status status = FlightFiles(folder).create(); !status) return status;
  const Result<Json> record = sweep_record(sweep, plan);
  if (!record) return record.error();
  return write_json(folder / "sweep.json", *record);
}

Result<Json> read_sweep_document(const fs::path& folder) {
  const fs::path file = folder / "sweep.json";
  Result<Json> record = read_json(file, kMaxSweepBytes);
  if (!record) return record.error();
  if (!record->is_object()) {
    return Error{ErrorCode::kUnreadable, file.string() + ": is no JSON object"};
  }
  for (const char* name : kRecorded) record->erase(name);
  return record;
}

Result<FlownSweep> fly_cells(const Sweep& sweep,
                             std::vector<SweepCell> cells,
                             const SweepOptions& options) {
  Result<SweepPlan> plan = SweepPlan::make(sweep, std::move(cells), options.cancel);
  if (!plan) return plan.error();
  if (options.lock != nullptr) return fly_plan(sweep, std::move(*plan), options);
  const Result<RunLock> lock = lock_sweep(options.folder);
  if (!lock) return lock.error();
  return fly_plan(sweep, std::move(*plan), options);
}

Result<FlownSweep> read_sweep(const Sweep& sweep,
                              const fs::path& folder,
                              const std::atomic<bool>* cancel) {
  Result<std::vector<SweepCell>> cells = cells_of(sweep);
  if (!cells) return cells.error();
  Result<SweepPlan> plan = SweepPlan::make(sweep, std::move(*cells), cancel);
  if (!plan) return plan.error();
  Result<SweepResults> results = SweepResults::read(folder);
  if (!results) return results.error();
  FlownSweep flown{std::move(*plan), std::move(*results), {}, false, {}};
  flown.progress.most = flown.plan.most_flights();
  // Every flight that is due is passed over, so that the plan reaches all known repeats.
  for (;;) {
    Result<std::optional<DueFlight>> due = flown.plan.next(flown.results, cancel);
    if (!due) return due.error();
    if (is_cancelled(cancel)) return Error{ErrorCode::kCancelled, "cancelled"};
    if (!*due) break;
    ++flown.progress.flown;
    flown.plan.over(**due);
  }
  flown.progress.passed = flown.progress.most - std::min(flown.progress.flown, flown.progress.most);
  flown.progress.flown = 0;
  return flown;
}

}  // namespace overfly::server::experiments
