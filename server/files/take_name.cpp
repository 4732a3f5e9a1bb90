#include "server/files/take_name.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace overfly::server {
namespace {

/// What the last system call says.
Result<bool> not_taken(const std::filesystem::path& name) {
  if (errno == EEXIST) return false;
  return Error{ErrorCode::kIo,
               name.string() + ": cannot create: " + std::generic_category().message(errno)};
}

}  // namespace

Result<bool> take_free_name(const std::filesystem::path& file, const std::filesystem::path& name) {
  if (::link(file.c_str(), name.c_str()) == 0) {
    ::unlink(file.c_str());
    return true;
  }
  const bool has_links =
      errno != EPERM && errno != EOPNOTSUPP && errno != ENOSYS && errno != EMLINK;
  if (has_links) return not_taken(name);
  if (::renameat2(AT_FDCWD, file.c_str(), AT_FDCWD, name.c_str(), RENAME_NOREPLACE) == 0) {
    return true;
  }
  const bool has_flag = errno != EINVAL && errno != ENOSYS;
  return has_flag ? not_taken(name) : take_reserved_name(file, name);
}

Result<bool> take_reserved_name(const std::filesystem::path& file,
                                const std::filesystem::path& name) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return not_taken(name);
  const bool is_folder = S_ISDIR(status.st_mode);
  if (is_folder) {
    if (::mkdir(name.c_str(), 0777) != 0) return not_taken(name);
  } else {
    const int reserved = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (reserved < 0) return not_taken(name);
    ::close(reserved);
  }
  if (::rename(file.c_str(), name.c_str()) == 0) return true;
  const int reason = errno;
  if (is_folder) {
    ::rmdir(name.c_str());
  } else {
    ::unlink(name.c_str());
  }
  errno = reason;
  return not_taken(name);
}

}  // namespace overfly::server
