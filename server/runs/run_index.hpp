// The runs of a folder, kept in memory.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/result.hpp"
#include "server/files/file_stamp.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {

/// Newest first. The entries are shared and immutable.
using RunList = std::vector<std::shared_ptr<const RunInfo>>;

/// Newest first: by time of creation, then by id.
[[nodiscard]] bool newer(const RunInfo& a, const RunInfo& b);

/// Thread-safe. Every call checks whether the folder's entries, their manifests or their notes have
/// changed and reads only the changed ones. Changes by other programs are thus seen at the next
/// call.
class RunIndex {
 public:
  explicit RunIndex(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// All runs of the folder.
  /// @param skip  ids that are neither read nor listed
  [[nodiscard]] RunList list(const std::set<std::string>& skip);
  /// One run. Errors: kNotFound.
  [[nodiscard]] Result<RunInfo> run(const std::string& id);
  /// Sets RunInfo::world_change of a run.
  void set_world_change(const std::string& id, const std::string& change);
  /// Lists how a run of this process has ended, if that could not be written to its manifest.
  void set_end(const std::string& id, const RunInfo& end);
  /// Lists a fault that was found when the run's data were read (RunInfo::problem), if its manifest
  /// has none; "" removes it.
  void set_fault(const std::string& id, const std::string& fault);

 private:
  struct Entry {
    FileStamp manifest;
    FileStamp notes;
    FileStamp metrics;
    /// Read after the last change of these files and of what is known below; only a change of them
    /// can change the run.
    bool settled = false;
    std::shared_ptr<const RunInfo> info;  ///< null if there is no manifest
    std::string world_change;
    std::string fault;
    struct End {
      RunStatus status;
      std::string error;
    };
    std::optional<End> unwritten_end;
  };
  /// Both return whether anything has changed. @pre mutex_ is held
  bool look_for_folders(int descriptor);
  bool look_at(int descriptor, const std::string& id, Entry& entry);
  /// The current entry of a run; null if there is none. @pre mutex_ is held
  Entry* find(const std::string& id);
  void sort();

  const std::filesystem::path folder_;
  std::mutex mutex_;
  FileStamp folder_stamp_;
  bool folder_settled_ = false;
  std::map<std::string, Entry> entries_;
  bool unsorted_ = false;
  RunList sorted_;
};

}  // namespace overfly::server
