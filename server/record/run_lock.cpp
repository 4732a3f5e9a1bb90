#include "server/record/run_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

/// Whether the file is still in its folder: its holder removes it before it lets go.
bool is_linked(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && status.st_nlink > 0;
}

/// Whether the path leads to the open file: the folder may have been renamed, and another one made
/// in its place.
bool leads_to(const fs::path& file, int descriptor) {
  struct stat here {};
  struct stat open {};
  return ::lstat(file.c_str(), &here) == 0 && ::fstat(descriptor, &open) == 0 &&
         here.st_dev == open.st_dev && here.st_ino == open.st_ino;
}

}  // namespace

fs::path RunLock::file_of(const fs::path& folder) { return folder / ".running"; }

Result<RunLock> RunLock::take(const fs::path& folder) {
  // held() has the lock for a moment: who asks must not be taken for who works.
  constexpr int kAttempts = 20;
  constexpr auto kPause = std::chrono::milliseconds(5);
  const fs::path file = file_of(folder);
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (attempt > 0) std::this_thread::sleep_for(kPause);
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (descriptor < 0) {
      return Error{ErrorCode::kIo, file.string() + ": cannot create: " + std::strerror(errno)};
    }
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0 && is_linked(descriptor)) {
      return RunLock(descriptor, file);
    }
    ::close(descriptor);
  }
  return Error{ErrorCode::kConflict, folder.string() + ": is in use by another process"};
}

bool RunLock::held(const fs::path& folder) {
  // Only to read: the folder may be of another user, or be mounted to be read only.
  const int descriptor =
      ::open(file_of(folder).c_str(), O_RDONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool held = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return held;
}

void RunLock::keep_room() const {
  // Many times a manifest, which lists every file of the world.
  constexpr off_t kRoomBytes = 256 << 10;
  (void)::posix_fallocate(descriptor_, 0, kRoomBytes);
}

void RunLock::free_room() const { (void)!::ftruncate(descriptor_, 0); }

RunLock::RunLock(int descriptor, fs::path file) : descriptor_(descriptor), file_(std::move(file)) {}

RunLock::RunLock(RunLock&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), file_(std::move(other.file_)) {}

RunLock& RunLock::operator=(RunLock&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(file_, other.file_);
  return *this;
}

RunLock::~RunLock() {
  if (descriptor_ < 0) return;
  if (leads_to(file_, descriptor_)) ::unlink(file_.c_str());
  ::close(descriptor_);
}

}  // namespace overfly::server
