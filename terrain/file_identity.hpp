// Which bytes a file name stands for, as far as the file system tells without reading them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace overfly::terrain {

/// Of the file that a name leads to, links followed. Another file, or one that was written to,
/// has another identity; one that was only given another owner or name may have, too.
struct FileIdentity {
  std::uint64_t device = 0;
  std::uint64_t inode = 0;
  std::uint64_t size_bytes = 0;
  std::int64_t modified_ns = 0;
  std::int64_t changed_ns = 0;  ///< of the inode (ctime): nobody can set it back

  bool operator==(const FileIdentity&) const = default;
  /// The same file, though it may have been written to since.
  [[nodiscard]] bool same_file(const FileIdentity& other) const {
    return device == other.device && inode == other.inode;
  }
  /// Neither its size nor its time of modification is another.
  [[nodiscard]] bool same_content(const FileIdentity& other) const {
    return size_bytes == other.size_bytes && modified_ns == other.modified_ns;
  }
};

/// Empty where there is no such file.
[[nodiscard]] std::optional<FileIdentity> file_identity(const std::filesystem::path& file);

}  // namespace overfly::terrain
