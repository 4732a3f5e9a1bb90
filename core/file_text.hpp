// Reads whole regular files up to a size limit, without blocking.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
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

/// Checks that a file exists and is regular, without opening it. Symbolic links are followed.
/// Errors: as read_file_text.
[[nodiscard]] Status check_regular_file(const std::filesystem::path& file);

}  // namespace overfly
