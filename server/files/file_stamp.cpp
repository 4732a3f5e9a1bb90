#include "server/files/file_stamp.hpp"

#include <fcntl.h>
#include <sys/stat.h>

namespace overfly::server {
namespace {

/// Times beyond 64 bits of nanoseconds wrap around: equal times stay equal.
std::int64_t ns_from(const timespec& time) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(time.tv_sec) * 1'000'000'000U +
                                   static_cast<std::uint64_t>(time.tv_nsec));
}

}  // namespace

FileStamp FileStamp::of(int folder, const std::string& name) {
  struct stat found {};
  FileStamp stamp;
  if (::fstatat(folder, name.c_str(), &found, 0) != 0) return stamp;
  stamp.exists = true;
  stamp.inode = found.st_ino;
  stamp.size_bytes = found.st_size;
  stamp.modified_ns = ns_from(found.st_mtim);
  stamp.changed_ns = ns_from(found.st_ctim);
  return stamp;
}

FileStamp FileStamp::of(const std::filesystem::path& file) { return of(AT_FDCWD, file.string()); }

bool FileStamp::settled(std::int64_t now_ns) const {
  constexpr std::int64_t kTickNs = 100'000'000;
  return !exists || changed_ns < now_ns - kTickNs || changed_ns > now_ns + kTickNs;
}

std::string content_key(const std::vector<std::filesystem::path>& files) {
  std::string key;
  for (const std::filesystem::path& file : files) {
    const FileStamp stamp = FileStamp::of(file);
    key += file.string() + '\n' + std::to_string(stamp.inode) + ' ' +
           std::to_string(stamp.size_bytes) + ' ' + std::to_string(stamp.modified_ns) + ' ' +
           std::to_string(stamp.changed_ns) + '\n';
  }
  return key;
}

}  // namespace overfly::server
