#include "server/runs/managed_runs.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <set>
#include <utility>

#include "server/record/run_id.hpp"
#include "server/record/run_info.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/worlds/world_change.hpp"

namespace overfly::server {
namespace {

RunInfo queued_info(const std::string& id, const Scenario& scenario) {
  RunInfo info;
  info.id = id;
  info.scenario = scenario.name;
  info.title = scenario.title;
  info.created_utc = utc_text(utc_now_ns());
  info.pacing = to_string(scenario.pacing);
  info.seed = scenario.seed;
  for (const CameraSpec& camera : scenario.cameras) info.cameras.push_back(camera.name);
  for (const EstimatorSpec& estimator : scenario.estimators) {
    info.estimators.push_back(estimator.name);
    info.estimator_cameras.push_back(scenario.cameras[estimator.camera].name);
  }
  return info;
}

MemoryBudget budget_of(const RunManagerOptions& options) {
  constexpr bool kViews = true;
  return options.memory_limit_bytes == 0 ? MemoryBudget::of_machine(kViews)
                                         : MemoryBudget(options.memory_limit_bytes, kViews);
}

}  // namespace

ManagedRuns::ManagedRuns(RunManagerOptions manager_options)
    : options(std::move(manager_options)),
      places(options.runs_folder, {options.sweeps_folder, options.studies_folder}),
      library({options.scenarios_folder,
               options.saved_scenarios_folder,
               options.allow_commands,
               [this] { return sources(); }}),
      index(options.runs_folder),
      shelf(places),
      budget_(budget_of(options)) {}

ManagedRuns::~ManagedRuns() {
  cancel_all();
  for (std::thread& thread : threads_) thread.join();
  for (const auto& run : queue_) release_run(options.runs_folder, run->id);
}

void ManagedRuns::cancel_all() {
  const std::lock_guard lock(mutex_);
  stopping_ = true;
  for (auto& [id, run] : runs_) run->cancel = true;
  wake_.notify_all();
}

SourcePolicy ManagedRuns::sources() const {
  if (!options.data_folders) return {};
  return data_folders().sources;
}

DataFolders ManagedRuns::data_folders() const {
  DataFolders data;
  data.folders = declared_folders(options.scenarios_folder);
  if (!options.data_folders) return data;
  data.folders.insert(
      data.folders.end(), options.data_folders->begin(), options.data_folders->end());
  data.closed = {options.runs_folder};
  for (const std::filesystem::path& folder : {options.sweeps_folder, options.studies_folder}) {
    if (!folder.empty()) data.closed.push_back(folder);
  }
  data.sources = SourcePolicy::inside(data.folders, data.closed);
  return data;
}

Status ManagedRuns::check_memory(const Scenario& scenario) const { return budget_.check(scenario); }

std::shared_ptr<const void> ManagedRuns::hold_memory(const RunMemory& memory) {
  const std::lock_guard lock(mutex_);
  RunMemory together = memory;
  int flying = 0;
  for (const auto& [id, run] : runs_) {
    if (!run->flies) continue;
    ++flying;
    together += run->memory;
  }
  // A run that waits although a thread is free for it waits for memory.
  if (!queue_.empty() && flying < options.max_parallel_runs) return nullptr;
  for (const RunMemory& other : held_) together += other;
  const bool only_one = flying == 0 && held_.empty();
  if (!only_one && !budget_.holds(together)) return nullptr;
  held_.push_back(memory);
  const auto place = std::prev(held_.end());
  return {&*place, [this, place](const void*) {
            {
              const std::lock_guard releasing(mutex_);
              held_.erase(place);
            }
            wake_.notify_all();
          }};
}

Result<RunInfo> ManagedRuns::enqueue(Scenario scenario,
                                     const IdempotencyKey& key,
                                     StartReport& report) {
  if (Status fits = budget_.check(scenario); !fits) {
    report.refusal = StartReport::Refusal::kMemory;
    return fits.error();
  }
  const std::lock_guard lock(mutex_);
  if (std::optional<Result<RunInfo>> earlier = info_by_key(key, report)) return *earlier;
  if (stopping_) return Error{ErrorCode::kConflict, "the server is stopping"};
  if (queue_.size() >= options.max_waiting_runs) {
    report.refusal = StartReport::Refusal::kQueueFull;
    return Error{ErrorCode::kConflict,
                 "waiting runs = " + std::to_string(queue_.size()) + ": must be below " +
                     std::to_string(options.max_waiting_runs) + " for another run to be queued"};
  }
  Result<std::string> id = reserve_run(options.runs_folder, scenario.name, utc_now_ns());
  if (!id) return id.error();
  auto run = std::make_shared<ManagedRun>();
  run->id = std::move(*id);
  run->memory = memory_of(scenario);
  RunInfo info = queued_info(run->id, scenario);
  run->timeline = std::make_shared<RunTimeline>(info, info.estimators);
  run->scenario = std::move(scenario);
  runs_[run->id] = run;
  keys_.keep(key, run->id, std::chrono::steady_clock::now());
  queue_.push_back(std::move(run));
  wake_.notify_all();
  return info;
}

std::optional<Result<RunInfo>> ManagedRuns::started_by(const IdempotencyKey& key,
                                                       StartReport& report) {
  const std::lock_guard lock(mutex_);
  return info_by_key(key, report);
}

std::optional<Result<RunInfo>> ManagedRuns::info_by_key(const IdempotencyKey& key,
                                                        StartReport& report) {
  const auto start = keys_.start_of(key.text, std::chrono::steady_clock::now());
  if (!start) return std::nullopt;
  const auto timeline = timeline_of(start->run_id);
  Result<RunInfo> info = timeline ? Result<RunInfo>(timeline->info()) : index.run(start->run_id);
  // Another program has deleted the run.
  if (!info) return std::nullopt;
  if (start->body_digest != key.body_digest) {
    report.refusal = StartReport::Refusal::kKeyUsed;
    return Error{ErrorCode::kConflict,
                 "Idempotency-Key = " + key.text + ": has started run \"" + start->run_id +
                     "\" with another body"};
  }
  report.repeated = true;
  return info;
}

RunList ManagedRuns::list() {
  RunList own;
  std::set<std::string> skip;
  {
    const std::lock_guard lock(mutex_);
    const auto add = [&](const ManagedRun& run) {
      own.push_back(std::make_shared<const RunInfo>(info_of(run)));
      skip.insert(run.id);
    };
    for (const auto& [id, run] : runs_) {
      if (!is_stored(*run)) add(*run);
    }
    for (const auto& run : unflown_) add(*run);
  }
  const auto first = [](const auto& a, const auto& b) { return newer(*a, *b); };
  std::sort(own.begin(), own.end(), first);
  const RunList stored = index.list(skip);
  if (own.empty()) return stored;
  RunList all;
  all.reserve(own.size() + stored.size());
  std::merge(own.begin(), own.end(), stored.begin(), stored.end(), std::back_inserter(all), first);
  return all;
}

std::shared_ptr<RunTimeline> ManagedRuns::timeline_of(const std::string& id) const {
  if (const auto run = runs_.find(id); run != runs_.end()) return run->second->timeline;
  for (const auto& run : unflown_) {
    if (run->id == id) return run->timeline;
  }
  return nullptr;
}

std::shared_ptr<RunTimeline> ManagedRuns::known_timeline(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  return timeline_of(id);
}

std::optional<RunInfo> ManagedRuns::known_info(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  if (const auto run = runs_.find(id); run != runs_.end()) {
    if (is_stored(*run->second)) return std::nullopt;
    return info_of(*run->second);
  }
  const auto timeline = timeline_of(id);
  return timeline ? std::optional<RunInfo>(timeline->info()) : std::nullopt;
}

bool ManagedRuns::is_stored(const ManagedRun& run) const {
  std::error_code ignored;
  return !server::is_live(*run.timeline) &&
         std::filesystem::exists(manifest_file(options.runs_folder / run.id), ignored);
}

RunInfo ManagedRuns::info_of(const ManagedRun& run) const {
  RunInfo info = run.timeline->info();
  const auto waiting = std::find_if(
      queue_.begin(), queue_.end(), [&](const auto& queued) { return queued.get() == &run; });
  if (waiting != queue_.end()) info.queue_position = waiting - queue_.begin() + 1;
  if (info.status == RunStatus::kRunning) info.left_s = run.pace.left_s(info.frames_total);
  return info;
}

void ManagedRuns::note_paces() {
  const auto now = std::chrono::steady_clock::now();
  for (auto& [id, run] : runs_) {
    if (run->flies) run->pace.add(now, run->timeline->info().frames);
  }
}

std::optional<Scenario> ManagedRuns::active_scenario(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto run = runs_.find(id);
  if (run == runs_.end()) return std::nullopt;
  return run->second->scenario;
}

WorldCache::Shared ManagedRuns::flown_world(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto run = runs_.find(id);
  return run == runs_.end() ? nullptr : run->second->world;
}

bool ManagedRuns::cancel(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto found = runs_.find(id);
  if (found == runs_.end() || !server::is_live(*found->second->timeline)) return false;
  const std::shared_ptr<ManagedRun> run = found->second;
  run->cancel = true;
  const auto waiting = std::find(queue_.begin(), queue_.end(), run);
  if (waiting == queue_.end()) return true;
  queue_.erase(waiting);
  runs_.erase(found);
  release_run(options.runs_folder, id);
  set_status(*run->timeline, RunStatus::kCancelled, "");
  keep_unflown(run);
  // The next run in the queue may fit where this one did not.
  wake_.notify_all();
  return true;
}

bool ManagedRuns::is_live(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto run = runs_.find(id);
  return run != runs_.end() && server::is_live(*run->second->timeline);
}

void ManagedRuns::keep_unflown(std::shared_ptr<ManagedRun> run) {
  unflown_.push_front(std::move(run));
  if (unflown_.size() > kKeptUnflown) unflown_.pop_back();
}

bool ManagedRuns::forget_unflown(const std::string& id) {
  const std::lock_guard lock(mutex_);
  if (std::erase_if(unflown_, [&](const auto& run) { return run->id == id; }) == 0) return false;
  keys_.forget_run(id);
  return true;
}

Result<std::shared_ptr<RunTimeline>> ManagedRuns::shelved_timeline(const std::string& id) {
  auto timeline = shelf.get(id);
  const bool damaged = !timeline && timeline.error().code == ErrorCode::kUnreadable;
  index.set_fault(id, damaged ? timeline.error().message : "");
  if (!timeline) return timeline;
  const Result<RunInfo> listed = index.run(id);
  if (!listed) return timeline;
  if ((*timeline)->info().world_change != listed->world_change) {
    (*timeline)->change_info([&](RunInfo& info) { info.world_change = listed->world_change; });
  }
  return timeline;
}

void ManagedRuns::tell_world_change(const std::string& id, const OpenedWorld& opened) {
  index.set_world_change(id, world_change(places.of(id), opened));
  // Its viewers are notified through its timeline.
  if (!known_timeline(id)) (void)shelved_timeline(id);
}

void ManagedRuns::forget(const std::string& id) {
  shelf.forget(id);
  const std::lock_guard lock(mutex_);
  keys_.forget_run(id);
  // Its thread may still hold it, and not have put its timeline on the shelf yet.
  if (const auto run = runs_.find(id); run != runs_.end()) {
    tell_deleted(*run->second->timeline);
    runs_.erase(run);
  }
  std::erase_if(unflown_, [&](const auto& run) { return run->id == id; });
}

}  // namespace overfly::server
