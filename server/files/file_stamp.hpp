// Whether a file was changed, without reading it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace overfly::engine {

/// What the system says of a file. Equal stamps of a settled file mean equal contents.
struct FileStamp {
  bool exists = false;
  std::uint64_t inode = 0;
  std::int64_t size_bytes = 0;
  std::int64_t modified_ns = 0;  ///< Unix time
  std::int64_t changed_ns = 0;   ///< of its inode, too

  /// @param folder  an open directory, or AT_FDCWD; links are followed
  [[nodiscard]] static FileStamp of(int folder, const std::string& name);
  [[nodiscard]] static FileStamp of(const std::filesystem::path& file);

  /// False while a further change could bear the same stamp: clocks of file systems tick slowly.
  [[nodiscard]] bool settled(std::int64_t now_ns) const;
  [[nodiscard]] bool operator==(const FileStamp&) const = default;
};

}  // namespace overfly::engine
