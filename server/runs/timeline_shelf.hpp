// Time lines of runs that are over, as long as their folders have not changed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "core/result.hpp"
#include "server/files/file_stamp.hpp"
#include "server/record/run_timeline.hpp"

namespace overfly::engine {

/// Thread-safe. Keeps those asked for last.
class TimelineShelf {
 public:
  static constexpr std::size_t kMostTimelines = 8;

  explicit TimelineShelf(std::filesystem::path runs_folder)
      : runs_folder_(std::move(runs_folder)) {}

  /// A run's time line, read from its folder where it is not here or its manifest has changed. New
  /// metrics are taken into the time line that is here. Errors: as RunTimeline::open.
  [[nodiscard]] Result<std::shared_ptr<RunTimeline>> get(const std::string& id);
  /// Takes the time line of a run that has just ended.
  void put(const std::string& id, std::shared_ptr<RunTimeline> timeline);
  void forget(const std::string& id);
  /// Takes new metrics into all time lines that are here, for those who watch them.
  void refresh();

 private:
  struct Entry {
    std::string id;
    std::shared_ptr<RunTimeline> timeline;
    FileStamp metrics;
    bool metrics_settled = false;
  };
  [[nodiscard]] Entry entry_of(const std::string& id) const;
  /// False where the entry is of a folder that is not there any more. @pre mutex_ is held
  bool is_fresh(Entry& entry) const;
  void keep(Entry entry);

  const std::filesystem::path runs_folder_;
  std::mutex mutex_;
  std::list<Entry> entries_;  ///< the one asked for last is in front
};

}  // namespace overfly::engine
