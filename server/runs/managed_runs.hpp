// The runs of this process, their threads, and what was read from disk.
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

#include "server/record/run_folder.hpp"
#include "server/record/run_info.hpp"
#include "server/record/run_timeline.hpp"
#include "server/runs/idempotency_keys.hpp"
#include "server/runs/run_index.hpp"
#include "server/runs/run_manager_options.hpp"
#include "server/runs/run_memory.hpp"
#include "server/runs/timeline_shelf.hpp"
#include "server/scenario/document/scenario_list.hpp"
#include "server/timing/picture_rate.hpp"
#include "server/worlds/world_cache.hpp"

namespace overfly::engine {

/// A run that this process was asked for, until it is over.
struct ManagedRun {
  std::string id;
  Scenario scenario;
  RunMemory memory;
  std::shared_ptr<RunTimeline> timeline;
  std::atomic<bool> cancel{false};
  WorldCache::Shared world;  ///< while it flies over it; guarded by the manager
  bool flies = false;        ///< else it waits
};

/// Whether it waits or flies.
[[nodiscard]] bool is_live(const RunTimeline& timeline);
void set_status(RunTimeline& timeline, RunStatus status, const std::string& error);

class ManagedRuns {
 public:
  /// Runs that ended before they had a folder are listed until so many newer ones did.
  static constexpr std::size_t kKeptUnflown = 8;

  explicit ManagedRuns(RunManagerOptions manager_options);
  /// Cancels and joins.
  ~ManagedRuns();
  /// Errors: kInternal with the system's reason.
  Status start_threads();

  /// What scenarios may name now: the declared folders follow the scenario files.
  [[nodiscard]] SourcePolicy sources() const;
  /// Errors: as RunManager::start, for a scenario that can be flown.
  Result<RunInfo> enqueue(Scenario scenario,
                          const std::string& idempotency_key,
                          StartReport& report);
  [[nodiscard]] std::optional<RunInfo> started_by(const std::string& idempotency_key);
  /// All runs, those of this process among them.
  [[nodiscard]] RunList list();
  /// Of runs that wait, fly, or ended without a folder.
  [[nodiscard]] std::optional<RunInfo> known_info(const std::string& id) const;
  [[nodiscard]] std::shared_ptr<RunTimeline> known_timeline(const std::string& id) const;
  /// Of a run that is over. Errors: as TimelineShelf::get.
  [[nodiscard]] Result<std::shared_ptr<RunTimeline>> shelved_timeline(const std::string& id);
  /// Says in the run's info how this world, opened for a view of it, differs from the one it flew.
  void tell_world_change(const std::string& id, const OpenedWorld& opened);
  /// Null when it does not fly here.
  [[nodiscard]] WorldCache::Shared flown_world(const std::string& id) const;
  [[nodiscard]] std::optional<Scenario> active_scenario(const std::string& id) const;
  /// False when the run is not queued or running here.
  bool cancel(const std::string& id);
  [[nodiscard]] bool is_live(const std::string& id) const;
  /// Forgets a run without a folder. False when there is no such run.
  bool forget_unflown(const std::string& id);
  /// Forgets a run whose folder is gone.
  void forget(const std::string& id);

  const RunManagerOptions options;
  WorldCache worlds;
  PictureRate picture_rate;
  RunIndex index;
  TimelineShelf shelf;

 private:
  void work();
  void watch();
  void fly(ManagedRun& run);
  void end(const std::shared_ptr<ManagedRun>& run);
  /// Lets a run go without a word of its own.
  void drop(const std::shared_ptr<ManagedRun>& run, const char* reason) noexcept;

  // These need mutex_ to be held.
  [[nodiscard]] std::optional<RunInfo> info_by_key(const std::string& idempotency_key);
  [[nodiscard]] std::shared_ptr<RunTimeline> timeline_of(const std::string& id) const;
  /// Whether the first in the queue may fly beside those that do.
  [[nodiscard]] bool next_fits() const;
  void keep_unflown(std::shared_ptr<ManagedRun> run);

  const MemoryBudget budget_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false;
  std::map<std::string, std::shared_ptr<ManagedRun>> runs_;  ///< that wait or fly
  std::deque<std::shared_ptr<ManagedRun>> queue_;
  std::deque<std::shared_ptr<ManagedRun>> unflown_;  ///< newest first
  IdempotencyKeys keys_;
  std::vector<std::thread> threads_;
};

}  // namespace overfly::engine
