#include "terrain/files/file_identity.hpp"

#include <sys/stat.h>

namespace overfly::terrain {
namespace {

std::int64_t ns_of(const timespec& time) {
  constexpr std::int64_t kNsPerS = 1'000'000'000;
  return static_cast<std::int64_t>(time.tv_sec) * kNsPerS + time.tv_nsec;
}

}  // namespace

std::optional<FileIdentity> file_identity(const std::filesystem::path& file) {
  struct stat found {};
  if (::stat(file.c_str(), &found) != 0) return std::nullopt;
  FileIdentity identity;
  identity.device = found.st_dev;
  identity.inode = found.st_ino;
  identity.size_bytes = static_cast<std::uint64_t>(found.st_size);
  identity.modified_ns = ns_of(found.st_mtim);
  identity.changed_ns = ns_of(found.st_ctim);
  return identity;
}

}  // namespace overfly::terrain
