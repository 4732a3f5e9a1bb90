// What RunManager keeps: the runs of this process, their threads, and what was read from disk.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/engine/picture_rate.hpp"
#include "server/engine/run_folder.hpp"
#include "server/engine/run_manager.hpp"
#include "server/engine/scenario_list.hpp"
#include "server/engine/world_cache.hpp"

namespace overfly::engine {

/// A run that this process was asked for; it stays here for a while after its end.
struct ManagedRun {
  std::string id;
  Scenario scenario;
  std::shared_ptr<RunTimeline> timeline;
  std::atomic<bool> cancel{false};
  WorldCache::Shared world;  ///< while it flies over it; guarded by the manager
};

struct RunManager::Impl {
  /// Timelines of runs that are over and are kept in memory: so many read from disk, and so many
  /// of this process.
  static constexpr std::size_t kKeptTimelines = 8;

  explicit Impl(RunManagerOptions manager_options);
  ~Impl();

  /// What scenarios may name now: the declared folders follow the scenario files.
  [[nodiscard]] SourcePolicy sources() const;
  RunInfo enqueue(Scenario scenario, const std::string& idempotency_key);
  [[nodiscard]] std::optional<RunInfo> started_by(const std::string& idempotency_key) const;
  [[nodiscard]] std::vector<RunInfo> active_infos() const;
  [[nodiscard]] std::shared_ptr<RunTimeline> known_timeline(const std::string& id);
  /// Null when it does not fly here.
  [[nodiscard]] WorldCache::Shared flown_world(const std::string& id) const;
  [[nodiscard]] std::optional<Scenario> active_scenario(const std::string& id) const;
  void remember(const std::string& id, std::shared_ptr<RunTimeline> timeline);
  /// False when the run is not queued or running here.
  bool cancel(const std::string& id);
  [[nodiscard]] bool is_live(const std::string& id) const;
  /// False when the run was not known.
  bool forget(const std::string& id);

  const RunManagerOptions options;
  WorldCache worlds;
  PictureRate picture_rate;

 private:
  void work();
  void fly(ManagedRun& run);
  [[nodiscard]] std::string new_id(const std::string& scenario);
  /// Lets the oldest runs go that are over and can be read from disk. @pre mutex_ is held
  void retire();
  /// @pre mutex_ is held
  [[nodiscard]] std::optional<RunInfo> info_by_key(const std::string& idempotency_key) const;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false;
  std::map<std::string, std::shared_ptr<ManagedRun>> runs_;
  std::deque<std::shared_ptr<ManagedRun>> queue_;
  std::map<std::string, std::string> id_by_key_;
  std::deque<std::pair<std::string, std::shared_ptr<RunTimeline>>> read_;  ///< newest first
  std::vector<std::thread> workers_;
};

}  // namespace overfly::engine
