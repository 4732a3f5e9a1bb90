#include "vo_bridges/process/child/private_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <string>
#include <system_error>
#include <utility>

namespace overfly::process {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPrefix = "overfly-estimator-";
/// A younger folder may be between its creation and its lock.
constexpr std::time_t kYoungestLeftS = 60;

FileDescriptor opened(const fs::path& folder) {
  return FileDescriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
}

bool lock(const FileDescriptor& folder) { return ::flock(folder.get(), LOCK_EX | LOCK_NB) == 0; }

/// Whether it is a folder of this user that nobody uses any more.
bool is_left(const fs::path& folder) {
  const FileDescriptor descriptor = opened(folder);
  struct stat status {};
  return descriptor.open() && ::fstat(descriptor.get(), &status) == 0 &&
         status.st_uid == ::geteuid() && status.st_mtime < std::time(nullptr) - kYoungestLeftS &&
         lock(descriptor);
}

/// Removes what programs that were killed have left.
void remove_left(const fs::path& temporary) {
  std::error_code failure;
  std::error_code ignored;
  for (fs::directory_iterator entry(temporary, failure), end; !failure && entry != end;
       entry.increment(failure)) {
    const bool is_such = entry->path().filename().string().starts_with(kPrefix);
    if (is_such && is_left(entry->path())) fs::remove_all(entry->path(), ignored);
  }
}

}  // namespace

Result<PrivateFolder> PrivateFolder::create() {
  std::error_code failure;
  fs::path temporary = fs::temp_directory_path(failure);
  if (failure) temporary = "/tmp";
  remove_left(temporary);
  std::string folder = (temporary / (std::string(kPrefix) + "XXXXXX")).string();
  if (::mkdtemp(folder.data()) == nullptr) {
    return Error{ErrorCode::kIo,
                 "cannot make folder " + folder + ": " + std::generic_category().message(errno)};
  }
  FileDescriptor held = opened(folder);
  if (!held.open()) {
    Error error{ErrorCode::kIo,
                "cannot open folder " + folder + ": " + std::generic_category().message(errno)};
    fs::remove(folder, failure);
    return error;
  }
  (void)lock(held);
  return PrivateFolder(folder, std::move(held));
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

PrivateFolder::PrivateFolder(PrivateFolder&& other) noexcept
    : path_(std::exchange(other.path_, {})), held_(std::move(other.held_)) {}

PrivateFolder& PrivateFolder::operator=(PrivateFolder&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(held_, other.held_);
  return *this;
}

}  // namespace overfly::process
