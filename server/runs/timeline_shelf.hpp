// Cache of the timelines of runs that are over, valid while their folders are unchanged.
#pragma once

#include <chrono>
#include <cstddef>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "core/result.hpp"
#include "server/files/file_stamp.hpp"
#include "server/runs/run_places.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {

/// For the viewers of a run, who keep what was read.
void tell_deleted(RunTimeline& timeline);

/// Thread-safe. Keeps the most recently used ones, and those that somebody else holds.
class TimelineShelf {
 public:
  static constexpr std::size_t kMostUnused = 8;

  explicit TimelineShelf(RunPlaces places) : places_(std::move(places)) {}

  /// A run's timeline; read from its folder if it is not cached or its manifest has changed. If
  /// only the metrics are new, updates the cached timeline. Errors: as RunTimeline::open.
  [[nodiscard]] Result<std::shared_ptr<RunTimeline>> get(const std::string& id);
  /// Adds the timeline of a run that has just ended.
  void put(const std::string& id, std::shared_ptr<RunTimeline> timeline);
  /// For a run that was deleted; notifies its viewers.
  void forget(const std::string& id);
  /// Updates the metrics of all cached timelines, and reports deleted runs, for their viewers.
  void refresh();

 private:
  struct Entry {
    std::string id;
    std::shared_ptr<RunTimeline> timeline;
    FileStamp metrics;
    bool metrics_settled = false;
    /// Until when a run that another process still writes counts as unchanged.
    std::optional<std::chrono::steady_clock::time_point> fresh_until;
  };
  [[nodiscard]] Entry entry_of(const std::string& id) const;
  /// False if the entry's folder no longer exists. @pre mutex_ is held
  bool is_fresh(Entry& entry) const;
  void keep(Entry entry);
  /// Keeps a timeline that was read, or gives the one that another thread has read meanwhile: only
  /// viewers of what is kept are notified.
  [[nodiscard]] std::shared_ptr<RunTimeline> kept(Entry entry);

  const RunPlaces places_;
  std::mutex mutex_;
  std::list<Entry> entries_;  ///< most recently used first
};

}  // namespace overfly::server
