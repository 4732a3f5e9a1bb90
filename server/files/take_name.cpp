#include "server/files/take_name.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace overfly::server {

Result<bool> take_free_name(const std::filesystem::path& file, const std::filesystem::path& name) {
  const auto failed = [&]() -> Result<bool> {
    if (errno == EEXIST) return false;
    return Error{ErrorCode::kIo,
                 name.string() + ": cannot create: " + std::generic_category().message(errno)};
  };
  if (::link(file.c_str(), name.c_str()) == 0) {
    ::unlink(file.c_str());
    return true;
  }
  const bool has_links =
      errno != EPERM && errno != EOPNOTSUPP && errno != ENOSYS && errno != EMLINK;
  if (has_links) return failed();
  if (::renameat2(AT_FDCWD, file.c_str(), AT_FDCWD, name.c_str(), RENAME_NOREPLACE) != 0) {
    return failed();
  }
  return true;
}

}  // namespace overfly::server
