#include "server/runs/run_index.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "server/files/plain_name.hpp"
#include "server/record/run_folder.hpp"
#include "server/runs/listed_run.hpp"

namespace overfly::server {
namespace {

/// An open directory; the descriptor is -1 if it does not exist.
class OpenFolder {
 public:
  explicit OpenFolder(const std::filesystem::path& folder)
      : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {}
  ~OpenFolder() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenFolder(const OpenFolder&) = delete;
  OpenFolder& operator=(const OpenFolder&) = delete;
  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

/// Names in a directory that may be runs.
std::set<std::string> names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  DIR* directory = ::opendir(folder.c_str());
  if (directory == nullptr) return names;
  while (const dirent* entry = ::readdir(directory)) {
    const bool folder_or_link =
        entry->d_type == DT_DIR || entry->d_type == DT_LNK || entry->d_type == DT_UNKNOWN;
    if (folder_or_link && is_plain_name(entry->d_name)) names.insert(entry->d_name);
  }
  ::closedir(directory);
  return names;
}

}  // namespace

bool newer(const RunInfo& a, const RunInfo& b) {
  return std::tie(a.created_utc, a.id) > std::tie(b.created_utc, b.id);
}

bool RunIndex::look_for_folders(int descriptor) {
  const FileStamp stamp = FileStamp::of(descriptor, ".");
  if (folder_settled_ && stamp == folder_stamp_) return false;
  folder_stamp_ = stamp;
  folder_settled_ = stamp.exists && stamp.settled(utc_now_ns());
  const std::set<std::string> names = names_in(folder_);
  const bool fewer =
      std::erase_if(entries_, [&](const auto& entry) { return names.count(entry.first) == 0; }) > 0;
  for (const std::string& name : names) entries_.try_emplace(name);
  return fewer;
}

bool RunIndex::look_at(int descriptor, const std::string& id, Entry& entry) {
  const FileStamp manifest = FileStamp::of(descriptor, id + "/manifest.json");
  const FileStamp notes = FileStamp::of(descriptor, id + "/notes.json");
  const FileStamp metrics = FileStamp::of(descriptor, id + "/metrics.json");
  const bool same = manifest == entry.manifest && notes == entry.notes && metrics == entry.metrics;
  if (entry.settled && same) return false;
  // What was found wrong may have been repaired.
  if (manifest != entry.manifest || metrics != entry.metrics) entry.fault.clear();
  const bool had_none = entry.info == nullptr;
  entry.manifest = manifest;
  entry.notes = notes;
  entry.metrics = metrics;
  entry.info = nullptr;
  if (manifest.exists) {
    if (Result<RunInfo> info = read_listed_run(folder_ / id); info) {
      info->world_change = entry.world_change;
      if (info->problem.empty()) info->problem = entry.fault;
      if (entry.unwritten_end && info->status == RunStatus::kInterrupted) {
        info->status = entry.unwritten_end->status;
        info->error = entry.unwritten_end->error;
      }
      entry.info = std::make_shared<const RunInfo>(std::move(*info));
    }
  }
  // A run that another process flies changes without a change of its manifest.
  const bool flies = entry.info && entry.info->status == RunStatus::kRunning;
  const std::int64_t now_ns = utc_now_ns();
  const auto is_settled = [&](const FileStamp& file) {
    return !file.exists || file.settled(now_ns);
  };
  entry.settled = manifest.settled(now_ns) && is_settled(notes) && is_settled(metrics) && !flies;
  return !had_none || entry.info != nullptr;
}

void RunIndex::sort() {
  unsorted_ = false;
  sorted_.clear();
  for (const auto& [id, entry] : entries_) {
    if (entry.info) sorted_.push_back(entry.info);
  }
  std::sort(
      sorted_.begin(), sorted_.end(), [](const auto& a, const auto& b) { return newer(*a, *b); });
}

RunList RunIndex::list(const std::set<std::string>& skip) {
  const std::lock_guard lock(mutex_);
  const OpenFolder folder(folder_);
  unsorted_ = look_for_folders(folder.descriptor()) || unsorted_;
  for (auto& [id, entry] : entries_) {
    if (skip.count(id) > 0) continue;
    unsorted_ = look_at(folder.descriptor(), id, entry) || unsorted_;
  }
  if (unsorted_) sort();
  if (skip.empty()) return sorted_;
  RunList list;
  list.reserve(sorted_.size());
  std::copy_if(sorted_.begin(), sorted_.end(), std::back_inserter(list), [&](const auto& info) {
    return skip.count(info->id) == 0;
  });
  return list;
}

RunIndex::Entry* RunIndex::find(const std::string& id) {
  if (!is_plain_name(id)) return nullptr;
  const OpenFolder folder(folder_);
  auto found = entries_.find(id);
  if (found == entries_.end()) {
    Entry entry;
    look_at(folder.descriptor(), id, entry);
    if (!entry.info) return nullptr;
    found = entries_.emplace(id, std::move(entry)).first;
    unsorted_ = true;
  } else {
    unsorted_ = look_at(folder.descriptor(), id, found->second) || unsorted_;
  }
  return found->second.info ? &found->second : nullptr;
}

Result<RunInfo> RunIndex::run(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const Entry* entry = find(id);
  if (entry == nullptr) return Error{ErrorCode::kNotFound, "run \"" + id + "\": no such run"};
  return *entry->info;
}

void RunIndex::set_world_change(const std::string& id, const std::string& change) {
  const std::lock_guard lock(mutex_);
  Entry* entry = find(id);
  if (entry == nullptr || entry->world_change == change) return;
  entry->world_change = change;
  entry->settled = false;
}

void RunIndex::set_end(const std::string& id, const RunInfo& end) {
  const std::lock_guard lock(mutex_);
  Entry* entry = find(id);
  if (entry == nullptr || entry->info->status != RunStatus::kInterrupted) return;
  entry->unwritten_end = {end.status, end.error};
  entry->settled = false;
}

void RunIndex::set_fault(const std::string& id, const std::string& fault) {
  const std::lock_guard lock(mutex_);
  Entry* entry = find(id);
  if (entry == nullptr || entry->fault == fault) return;
  entry->fault = fault;
  entry->settled = false;
}

}  // namespace overfly::server
