#include "server/runs/run_removal.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "server/files/file_stamp.hpp"
#include "server/record/run_folder.hpp"
#include "server/record/run_id.hpp"
#include "server/record/run_lock.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

/// Prefix of folders renamed for deletion. No run's id begins with a dot.
constexpr const char* kAside = ".deleted-";

/// Renames a folder so that no list shows it. Errors: kNotFound; kIo.
Result<fs::path> put_aside(const fs::path& folder) {
  const std::string id = folder.filename().string();
  fs::path aside = folder.parent_path() / (kAside + id + "-" + std::to_string(utc_now_ns()));
  if (std::rename(folder.c_str(), aside.c_str()) == 0) return aside;
  if (errno == ENOENT) return Error{ErrorCode::kNotFound, "run \"" + id + "\": no such run"};
  return Error{ErrorCode::kIo, folder.string() + ": cannot delete: " + std::strerror(errno)};
}

}  // namespace

Result<fs::path> put_run_folder_aside(const fs::path& folder) {
  std::error_code failure;
  std::optional<RunLock> lock;
  // Of a symbolic link only the link is deleted: nothing is written to its target.
  if (!fs::is_symlink(folder, failure)) {
    Result<RunLock> taken = RunLock::take(folder);
    if (!taken && FileStamp::of(folder).exists) return taken.error();
    if (taken) lock = std::move(*taken);
  }
  return put_aside(folder);
}

Status remove_run_folder(const fs::path& folder) {
  const Result<fs::path> aside = put_run_folder_aside(folder);
  if (!aside) return aside.error();
  std::error_code failure;
  fs::remove_all(*aside, failure);
  if (failure) return Error{ErrorCode::kIo, folder.string() + ": " + failure.message()};
  return {};
}

void remove_leftovers(const fs::path& runs_folder) {
  constexpr std::int64_t kDayNs = 86'400'000'000'000;
  std::vector<fs::path> aside;
  std::vector<fs::path> old;
  std::error_code failure;
  for (fs::directory_iterator entry(runs_folder, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    const fs::path path = entry->path();
    if (path.filename().string().starts_with(kAside)) {
      aside.push_back(path);
    } else if (is_run_id(path.filename().string()) &&
               FileStamp::of(path).changed_ns < utc_now_ns() - kDayNs) {
      old.push_back(path);
    }
  }
  for (const fs::path& path : aside) fs::remove_all(path, failure);
  for (const fs::path& path : old) {
    if (fs::is_directory(path, failure) && fs::is_empty(path, failure)) fs::remove(path, failure);
  }
}

}  // namespace overfly::server
