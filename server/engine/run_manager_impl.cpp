#include "server/engine/run_manager_impl.hpp"

#include <algorithm>
#include <utility>

namespace overfly::engine {
namespace {

bool live(const RunTimeline& timeline) {
  const RunStatus status = timeline.info().status;
  return status == RunStatus::kQueued || status == RunStatus::kRunning;
}

RunInfo queued_info(const std::string& id, const Scenario& scenario) {
  RunInfo info;
  info.id = id;
  info.scenario = scenario.name;
  info.title = scenario.title;
  info.created_utc = utc_text(utc_now_ns());
  info.pacing = to_string(scenario.pacing);
  for (const CameraSpec& camera : scenario.cameras) info.cameras.push_back(camera.name);
  for (const EstimatorSpec& estimator : scenario.estimators) {
    info.estimators.push_back(estimator.name);
    info.estimator_cameras.push_back(scenario.cameras[estimator.camera].name);
  }
  return info;
}

void set_status(RunTimeline& timeline, RunStatus status, const std::string& error) {
  RunInfo info = timeline.info();
  info.status = status;
  info.error = error;
  timeline.set_info(info);
}

}  // namespace

RunManager::Impl::Impl(RunManagerOptions manager_options) : options(std::move(manager_options)) {
  for (int i = 0; i < options.max_parallel_runs; ++i) workers_.emplace_back([this] { work(); });
}

RunManager::Impl::~Impl() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    queue_.clear();
    for (auto& [id, run] : runs_) run->cancel = true;
  }
  wake_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

SourcePolicy RunManager::Impl::sources() const {
  if (!options.data_folders) return {};
  std::vector<std::filesystem::path> folders = declared_folders(options.scenarios_folder);
  folders.insert(folders.end(), options.data_folders->begin(), options.data_folders->end());
  return SourcePolicy::inside(std::move(folders), {options.runs_folder});
}

std::string RunManager::Impl::new_id(const std::string& scenario) {
  // 2026-11-21T09:12:04Z -> 20261121-091204
  std::string stamp = utc_text(utc_now_ns());
  std::erase_if(stamp, [](char c) { return c == '-' || c == ':' || c == 'Z'; });
  std::replace(stamp.begin(), stamp.end(), 'T', '-');
  const std::string base = stamp + "-" + scenario;
  std::string id = base;
  std::error_code ignored;
  for (int n = 2; runs_.count(id) > 0 || std::filesystem::exists(options.runs_folder / id, ignored);
       ++n) {
    id = base + "-" + std::to_string(n);
  }
  return id;
}

RunInfo RunManager::Impl::enqueue(Scenario scenario, const std::string& idempotency_key) {
  const std::lock_guard lock(mutex_);
  if (std::optional<RunInfo> earlier = info_by_key(idempotency_key)) return *earlier;
  auto run = std::make_shared<ManagedRun>();
  run->id = new_id(scenario.name);
  RunInfo info = queued_info(run->id, scenario);
  run->timeline = std::make_shared<RunTimeline>(info, info.estimators);
  run->scenario = std::move(scenario);
  runs_[run->id] = run;
  if (!idempotency_key.empty()) id_by_key_[idempotency_key] = run->id;
  queue_.push_back(std::move(run));
  wake_.notify_one();
  return info;
}

std::optional<RunInfo> RunManager::Impl::started_by(const std::string& idempotency_key) const {
  const std::lock_guard lock(mutex_);
  return info_by_key(idempotency_key);
}

std::optional<RunInfo> RunManager::Impl::info_by_key(const std::string& idempotency_key) const {
  const auto id = id_by_key_.find(idempotency_key);
  if (id == id_by_key_.end()) return std::nullopt;
  const auto run = runs_.find(id->second);
  if (run != runs_.end()) return run->second->timeline->info();
  const Result<RunInfo> info = read_run_info(options.runs_folder / id->second);
  return info ? std::optional<RunInfo>(*info) : std::nullopt;
}

void RunManager::Impl::retire() {
  std::vector<std::pair<std::string, std::string>> over;  // (created, id): the oldest first
  for (const auto& [id, run] : runs_) {
    std::error_code ignored;
    if (live(*run->timeline)) continue;
    if (!std::filesystem::exists(manifest_file(options.runs_folder / id), ignored)) continue;
    over.emplace_back(run->timeline->info().created_utc, id);
  }
  std::sort(over.begin(), over.end());
  for (std::size_t i = 0; i + kKeptTimelines < over.size(); ++i) runs_.erase(over[i].second);
}

std::vector<RunInfo> RunManager::Impl::active_infos() const {
  const std::lock_guard lock(mutex_);
  std::vector<RunInfo> infos;
  infos.reserve(runs_.size());
  for (const auto& [id, run] : runs_) infos.push_back(run->timeline->info());
  return infos;
}

std::shared_ptr<RunTimeline> RunManager::Impl::known_timeline(const std::string& id) {
  const std::lock_guard lock(mutex_);
  if (const auto run = runs_.find(id); run != runs_.end()) return run->second->timeline;
  for (const auto& [read_id, timeline] : read_) {
    if (read_id == id) return timeline;
  }
  return nullptr;
}

std::optional<Scenario> RunManager::Impl::active_scenario(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto run = runs_.find(id);
  if (run == runs_.end()) return std::nullopt;
  return run->second->scenario;
}

WorldCache::Shared RunManager::Impl::flown_world(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto run = runs_.find(id);
  return run == runs_.end() ? nullptr : run->second->world;
}

void RunManager::Impl::remember(const std::string& id, std::shared_ptr<RunTimeline> timeline) {
  const std::lock_guard lock(mutex_);
  read_.emplace_front(id, std::move(timeline));
  if (read_.size() > kKeptTimelines) read_.pop_back();
}

bool RunManager::Impl::cancel(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto found = runs_.find(id);
  if (found == runs_.end() || !live(*found->second->timeline)) return false;
  const std::shared_ptr<ManagedRun>& run = found->second;
  run->cancel = true;
  const auto waiting = std::find(queue_.begin(), queue_.end(), run);
  if (waiting != queue_.end()) {
    queue_.erase(waiting);
    set_status(*run->timeline, RunStatus::kCancelled, "");
  }
  return true;
}

bool RunManager::Impl::is_live(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto run = runs_.find(id);
  return run != runs_.end() && live(*run->second->timeline);
}

bool RunManager::Impl::forget(const std::string& id) {
  const std::lock_guard lock(mutex_);
  std::erase_if(read_, [&](const auto& entry) { return entry.first == id; });
  std::erase_if(id_by_key_, [&](const auto& entry) { return entry.second == id; });
  return runs_.erase(id) > 0;
}

void RunManager::Impl::work() {
  while (true) {
    std::shared_ptr<ManagedRun> run;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return stopping_ || !queue_.empty(); });
      if (stopping_) return;
      run = queue_.front();
      queue_.pop_front();
    }
    fly(*run);
    const std::lock_guard lock(mutex_);
    retire();
  }
}

void RunManager::Impl::fly(ManagedRun& run) {
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
    run.world = std::move(world);
  };
  run_options.world_opened = set_world;
  run_options.notice = [&run](const std::string& text) {
    // The run's own next change of its info takes it away again.
    RunInfo info = run.timeline->info();
    info.notice = text;
    run.timeline->set_info(info);
  };
  const Result<RunResult> result = run_scenario(run.scenario, run_options);
  set_world(nullptr);
  // The run itself tells its timeline how it ended; only one that could not even make its folder
  // has had no chance to.
  if (!result && live(*run.timeline)) {
    set_status(*run.timeline, RunStatus::kFailed, result.error().message);
  }
}

}  // namespace overfly::engine
