// ManagedRuns: its threads, which fly what waits and look after what is over.
#include <chrono>
#include <exception>
#include <system_error>
#include <utility>

#include "server/record/run_id.hpp"
#include "server/record/run_info.hpp"
#include "server/run/run.hpp"
#include "server/run/run_options.hpp"
#include "server/runs/managed_runs.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {
namespace {

/// How often files of runs that are over are checked for their viewers.
constexpr std::chrono::seconds kWatchPeriod{1};

}  // namespace

bool is_live(const RunTimeline& timeline) {
  const RunStatus status = timeline.info().status;
  return status == RunStatus::kQueued || status == RunStatus::kRunning;
}

void set_status(RunTimeline& timeline, RunStatus status, const std::string& error) {
  timeline.change_info([&](RunInfo& info) {
    info.status = status;
    info.error = error;
  });
}

Status ManagedRuns::start_threads() {
  try {
    for (int i = 0; i < options.max_parallel_runs; ++i) threads_.emplace_back([this] { work(); });
    threads_.emplace_back([this] { watch(); });
    return {};
  } catch (const std::system_error& error) {
    return Error{ErrorCode::kInternal,
                 "thread " + std::to_string(threads_.size() + 1) + " of " +
                     std::to_string(options.max_parallel_runs + 1) +
                     " for runs cannot be started: " + error.what()};
  }
}

bool ManagedRuns::next_fits() const {
  RunMemory together = queue_.front()->memory;
  bool only_one = true;
  for (const auto& [id, run] : runs_) {
    if (!run->flies) continue;
    only_one = false;
    together += run->memory;
  }
  for (const RunMemory& other : held_) {
    only_one = false;
    together += other;
  }
  // A run that does not fit without others was rejected when it was requested.
  return only_one || budget_.holds(together);
}

void ManagedRuns::work() {
  while (true) {
    std::shared_ptr<ManagedRun> run;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return stopping_ || (!queue_.empty() && next_fits()); });
      if (stopping_) return;
      run = queue_.front();
      queue_.pop_front();
      run->flies = true;
    }
    try {
      fly(*run);
      end(run);
    } catch (const std::exception& error) {
      // Out of memory even to record the failure: this run is over, the others continue.
      drop(run, error.what());
    }
    // Other runs may have waited for its memory.
    wake_.notify_all();
  }
}

void ManagedRuns::drop(const std::shared_ptr<ManagedRun>& run, const char* reason) noexcept {
  const std::lock_guard lock(mutex_);
  runs_.erase(run->id);
  try {
    if (server::is_live(*run->timeline)) set_status(*run->timeline, RunStatus::kFailed, reason);
    log_failure(run->id, reason);
  } catch (const std::exception&) {
    // Its folder shows it as interrupted.
  }
}

void ManagedRuns::end(const std::shared_ptr<ManagedRun>& run) {
  std::error_code ignored;
  const bool has_folder =
      std::filesystem::exists(manifest_file(options.runs_folder / run->id), ignored);
  if (has_folder) {
    shelf.put(run->id, run->timeline);
    index.set_end(run->id, run->timeline->info());
  } else if (!run->recorded) {
    release_run(options.runs_folder, run->id);
  }
  const std::lock_guard lock(mutex_);
  // False if the run was deleted just after its end.
  const bool known = runs_.erase(run->id) > 0;
  // A folder that is gone again was deleted by a client: listing the run would let another delete
  // it.
  if (!run->recorded && known) keep_unflown(run);
}

void ManagedRuns::watch() {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, kWatchPeriod, [this] { return stopping_; })) {
    note_paces();
    lock.unlock();
    try {
      shelf.refresh();
    } catch (const std::exception&) {
      // Out of memory: the files are checked again in a moment.
    }
    lock.lock();
  }
}

void ManagedRuns::log_failure(const std::string& id, const std::string& reason) const {
  if (options.log) options.log("error", "run " + id + " failed: " + reason);
}

void ManagedRuns::fly(ManagedRun& run) {
  RunOptions run_options;
  run_options.folder = options.runs_folder / run.id;
  run_options.renderer_factory = options.renderer_factory;
  run_options.cancel = &run.cancel;
  run_options.timeline = run.timeline;
  run_options.publish_images = true;
  run_options.worlds = &worlds;
  run_options.picture_rate = &picture_rate;
  const auto set_world = [this, &run](WorldCache::Shared world) {
    const std::lock_guard lock(mutex_);
    std::swap(run.world, world);  // a released world is closed without the lock held
  };
  run_options.world_opened = set_world;
  run_options.notice = [&run](const std::string& text) {
    // The run's next update of its info clears it again.
    run.timeline->change_info([&](RunInfo& info) { info.notice = text; });
  };
  const Result<RunResult> result = run_scenario(run.scenario, run_options);
  set_world(nullptr);
  // The run itself sets its final state in the timeline, unless it failed before it could create
  // its folder.
  run.recorded = result.ok() || !server::is_live(*run.timeline);
  if (!run.recorded) {
    set_status(*run.timeline, RunStatus::kFailed, result.error().message);
  }
  if (!result) log_failure(run.id, result.error().message);
}

}  // namespace overfly::server
