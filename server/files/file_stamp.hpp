// Detects whether a file was changed, without reading it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace overfly::server {

/// File metadata from the system. Equal stamps of a settled file mean equal contents.
struct FileStamp {
  bool exists = false;
  std::uint64_t inode = 0;
  std::int64_t size_bytes = 0;
  std::int64_t modified_ns = 0;  ///< Unix time
  std::int64_t changed_ns = 0;   ///< Unix time; of its inode too

  /// @param folder  an open directory, or AT_FDCWD; symbolic links are followed
  [[nodiscard]] static FileStamp of(int folder, const std::string& name);
  [[nodiscard]] static FileStamp of(const std::filesystem::path& file);

  /// False while a further change could get the same stamp, because file system clocks are coarse.
  [[nodiscard]] bool settled(std::int64_t now_ns) const;
  [[nodiscard]] bool operator==(const FileStamp&) const = default;
};

/// Identifies the contents of files without reading them: paths and stamps.
[[nodiscard]] std::string content_key(const std::vector<std::filesystem::path>& files);

}  // namespace overfly::server
