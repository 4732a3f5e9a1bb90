// Files read whole: of the expected kind, within a size, and without waiting for a writer.
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

/// The whole content of a regular file (links are followed).
///
/// Opens without blocking, so a FIFO or a device never holds the caller up. The size is checked
/// before and while reading, because files of the kernel say 0 bytes whatever they hold.
/// @param max_bytes  a longer file is refused, unread where the file system knows its size
/// @param cancel     looked at between pieces of 1 MiB; may be null
/// Errors: kNotFound; kUnreadable for a folder, for what is no regular file and for a file beyond
/// `max_bytes`; kIo with the system's reason; kCancelled. Each names the file.
[[nodiscard]] Result<std::string> read_file_text(const std::filesystem::path& file,
                                                 std::uint64_t max_bytes,
                                                 const std::atomic<bool>* cancel = nullptr);

/// The same as bytes.
[[nodiscard]] Result<std::vector<std::uint8_t>> read_file_bytes(const std::filesystem::path& file,
                                                                std::uint64_t max_bytes);

/// The same piece by piece, for what need not be kept.
[[nodiscard]] Status read_file_pieces(const std::filesystem::path& file,
                                      std::uint64_t max_bytes,
                                      const std::atomic<bool>* cancel,
                                      const std::function<void(std::string_view)>& take);

/// Whether a file is there and regular (links are followed), without opening it.
/// Errors: as read_file_text.
[[nodiscard]] Status check_regular_file(const std::filesystem::path& file);

}  // namespace overfly
