#include "server/record/run_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

/// Locked by flock(2).
fs::path lock_file(const fs::path& folder) { return folder / ".running"; }

}  // namespace

Result<RunLock> RunLock::take(const fs::path& folder) {
  const fs::path file = lock_file(folder);
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor < 0) {
    return Error{ErrorCode::kIo, file.string() + ": cannot create: " + std::strerror(errno)};
  }
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    ::close(descriptor);
    return Error{ErrorCode::kConflict, folder.string() + ": is in use by another process"};
  }
  return RunLock(descriptor, file);
}

bool RunLock::held(const fs::path& folder) {
  const int descriptor = ::open(lock_file(folder).c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool held = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return held;
}

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
  ::unlink(file_.c_str());
  ::close(descriptor_);
}

}  // namespace overfly::server
