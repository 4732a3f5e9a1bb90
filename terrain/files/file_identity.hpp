// Identity of a file's content, from file system metadata without reading it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace overfly::terrain {

/// Of the file that a name refers to, symbolic links followed. Another file, or one that was
/// written to, has another identity; a change of owner or name may change it too.
struct FileIdentity {
  std::uint64_t device = 0;
  std::uint64_t inode = 0;
  std::uint64_t size_bytes = 0;
  std::int64_t modified_ns = 0;
  std::int64_t changed_ns = 0;  ///< of the inode (ctime), which programs cannot set back

  bool operator==(const FileIdentity&) const = default;
  /// The same file, although it may have been written to since.
  [[nodiscard]] bool same_file(const FileIdentity& other) const {
    return device == other.device && inode == other.inode;
  }
  /// Size and modification time are equal.
  [[nodiscard]] bool same_content(const FileIdentity& other) const {
    return size_bytes == other.size_bytes && modified_ns == other.modified_ns;
  }
};

/// Empty if there is no such file.
[[nodiscard]] std::optional<FileIdentity> file_identity(const std::filesystem::path& file);

}  // namespace overfly::terrain
