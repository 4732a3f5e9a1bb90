// The runs of this process, their threads, and what was read from disk.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/record/run_folder.hpp"
#include "server/record/run_info.hpp"
#include "server/runs/idempotency_keys.hpp"
#include "server/runs/run_index.hpp"
#include "server/runs/run_manager_options.hpp"
#include "server/runs/run_memory.hpp"
#include "server/runs/run_pace.hpp"
#include "server/runs/run_places.hpp"
#include "server/runs/scenario_library.hpp"
#include "server/runs/timeline_shelf.hpp"
#include "server/scenario/document/scenario_list.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/timing/picture_rate.hpp"
#include "server/worlds/world_cache.hpp"

namespace overfly::server {

/// A run requested from this process, until it is over.
struct ManagedRun {
  std::string id;
  Scenario scenario;
  RunMemory memory;
  std::shared_ptr<RunTimeline> timeline;
  std::atomic<bool> cancel{false};
  WorldCache::Shared world;  ///< while the run flies over it; guarded by the manager
  bool recorded = false;     ///< it had a folder when it ended
  bool flies = false;        ///< false: queued
  RunPace pace;              ///< guarded by the manager
};

/// Whether it is queued or flying.
[[nodiscard]] bool is_live(const RunTimeline& timeline);
void set_status(RunTimeline& timeline, RunStatus status, const std::string& error);

class ManagedRuns {
 public:
  /// Number of runs listed that ended before they had a folder; older ones are dropped.
  static constexpr std::size_t kKeptUnflown = 8;

  explicit ManagedRuns(RunManagerOptions manager_options);
  /// Cancels and joins.
  ~ManagedRuns();
  /// Errors: kInternal with the system's reason.
  Status start_threads();

  /// Sources that scenarios may name now: the declared folders follow the scenario files.
  [[nodiscard]] SourcePolicy sources() const;
  [[nodiscard]] DataFolders data_folders() const;
  /// As RunManager.
  [[nodiscard]] Status check_memory(const Scenario& scenario) const;
  [[nodiscard]] std::shared_ptr<const void> hold_memory(const RunMemory& memory);
  /// Errors: as RunManager::start, for a valid scenario.
  Result<RunInfo> enqueue(Scenario scenario, const IdempotencyKey& key, StartReport& report);
  /// The run that the key has started, for the same request. Errors: kConflict for another one.
  [[nodiscard]] std::optional<Result<RunInfo>> started_by(const IdempotencyKey& key,
                                                          StartReport& report);
  /// All runs, including those of this process.
  [[nodiscard]] RunList list();
  /// For runs that are queued, fly, or ended without a folder.
  [[nodiscard]] std::optional<RunInfo> known_info(const std::string& id) const;
  [[nodiscard]] std::shared_ptr<RunTimeline> known_timeline(const std::string& id) const;
  /// For a run that is over. Errors: as TimelineShelf::get.
  [[nodiscard]] Result<std::shared_ptr<RunTimeline>> shelved_timeline(const std::string& id);
  /// Records in the run's info how this world, opened for a view, differs from the one it flew
  /// over.
  void tell_world_change(const std::string& id, const OpenedWorld& opened);
  /// Null if the run does not fly in this process.
  [[nodiscard]] WorldCache::Shared flown_world(const std::string& id) const;
  [[nodiscard]] std::optional<Scenario> active_scenario(const std::string& id) const;
  /// False if the run is not queued or running in this process.
  bool cancel(const std::string& id);
  /// As RunManager.
  void cancel_all();
  [[nodiscard]] bool is_live(const std::string& id) const;
  /// Forgets a run without a folder. False if there is no such run.
  bool forget_unflown(const std::string& id);
  /// Forgets a run whose folder was deleted.
  void forget(const std::string& id);

  const RunManagerOptions options;
  const RunPlaces places;
  ScenarioLibrary library;
  WorldCache worlds;
  PictureRate picture_rate;
  RunIndex index;
  TimelineShelf shelf;
  std::mutex writing_notes;

 private:
  void work();
  void watch();
  void fly(ManagedRun& run);
  void log_failure(const std::string& id, const std::string& reason) const;
  void end(const std::shared_ptr<ManagedRun>& run);
  /// Removes a run that did not set a final state itself.
  void drop(const std::shared_ptr<ManagedRun>& run, const char* reason) noexcept;

  // @pre for those below: mutex_ is held
  [[nodiscard]] std::optional<Result<RunInfo>> info_by_key(const IdempotencyKey& key,
                                                           StartReport& report);
  [[nodiscard]] std::shared_ptr<RunTimeline> timeline_of(const std::string& id) const;
  [[nodiscard]] RunInfo info_of(const ManagedRun& run) const;
  /// Whether it is over and its folder has all of its data.
  [[nodiscard]] bool is_stored(const ManagedRun& run) const;
  void note_paces();
  /// Whether the first run in the queue fits in memory next to the flying ones.
  [[nodiscard]] bool next_fits() const;
  void keep_unflown(std::shared_ptr<ManagedRun> run);

  const MemoryBudget budget_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false;
  std::map<std::string, std::shared_ptr<ManagedRun>> runs_;  ///< queued or flying
  std::deque<std::shared_ptr<ManagedRun>> queue_;
  std::list<RunMemory> held_;                        ///< by hold_memory
  std::deque<std::shared_ptr<ManagedRun>> unflown_;  ///< newest first
  IdempotencyKeys keys_;
  std::vector<std::thread> threads_;
};

}  // namespace overfly::server
