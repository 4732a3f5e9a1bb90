// Reads whole regular files up to a size limit, without blocking.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/result.hpp"

namespace overfly {

/// Reads a regular file completely. Symbolic links are followed.
///
/// The file is opened without blocking, so a FIFO or a device cannot block the caller. The size is
/// checked before and during reading, because files of the kernel (/proc, /sys) report 0 bytes.
/// @param max_bytes  size limit; a larger file is rejected unread if the file system reports its
/// size
/// @param cancel     checked after every 1 MiB; may be null
/// Errors: kNotFound; kUnreadable for a folder, for anything else that is not a regular file, and
/// for a file larger than `max_bytes`; kIo with the system's reason; kCancelled. Each names the
/// file.
[[nodiscard]] Result<std::string> read_file_text(const std::filesystem::path& file,
                                                 std::uint64_t max_bytes,
                                                 const std::atomic<bool>* cancel = nullptr);

/// As read_file_text, but returns bytes.
[[nodiscard]] Result<std::vector<std::uint8_t>> read_file_bytes(const std::filesystem::path& file,
                                                                std::uint64_t max_bytes);

/// As read_file_text, but passes the content to `take` piece by piece.
[[nodiscard]] Status read_file_pieces(const std::filesystem::path& file,
                                      std::uint64_t max_bytes,
                                      const std::atomic<bool>* cancel,
                                      const std::function<void(std::string_view)>& take);

/// A regular file that is open for reading at any place.
class ReadableFile {
 public:
  /// Symbolic links are followed. Errors: as read_file_text, but without a size limit.
  [[nodiscard]] static Result<ReadableFile> open(const std::filesystem::path& file);
  ~ReadableFile();
  ReadableFile(ReadableFile&& other) noexcept;
  ReadableFile& operator=(ReadableFile&& other) noexcept;

  /// The present size; a file may grow while it is open. Errors: kIo.
  [[nodiscard]] Result<std::uint64_t> size_bytes() const;
  /// Reads what is there at an offset, up to bytes.size(); 0 at the end. Errors: kIo.
  [[nodiscard]] Result<std::size_t> read_some(std::uint64_t offset,
                                              std::span<std::uint8_t> bytes) const;
  /// Fills `bytes` from an offset of the file. Errors: kIo, also if the file ends earlier.
  [[nodiscard]] Status read_at(std::uint64_t offset, std::span<std::uint8_t> bytes) const;

 private:
  ReadableFile(int descriptor, std::filesystem::path file)
      : descriptor_(descriptor), file_(std::move(file)) {}

  int descriptor_ = -1;
  std::filesystem::path file_;
};

/// Checks that a file exists and is regular, without opening it. Symbolic links are followed.
/// Errors: as read_file_text.
[[nodiscard]] Status check_regular_file(const std::filesystem::path& file);

}  // namespace overfly
