// Reads a large regular file from start to end through one buffer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>
#include <vector>

#include "core/outside/file_text.hpp"
#include "core/result.hpp"

namespace overfly {

/// A regular file of any size, read once from start to end in bounded memory.
///
/// The file is read with pread into a buffer, not mapped: a mapped file that another program
/// shortens would end this program with SIGBUS. Here it only ends early.
class ForwardReader {
 public:
  static constexpr std::size_t kBufferBytes = std::size_t{1} << 20U;

  /// Symbolic links are followed. Errors: as ReadableFile::open.
  [[nodiscard]] static Result<ForwardReader> open(const std::filesystem::path& file);

  /// The bytes that follow position(): at least `wanted` of them, or all that remain. The span is
  /// valid until the next call. Bytes appended after open() are not read.
  /// @pre wanted <= kBufferBytes
  /// Errors: kIo.
  [[nodiscard]] Result<std::span<const std::uint8_t>> ahead(std::size_t wanted);
  /// Moves the position forward. @pre at most as many bytes as ahead() last returned
  void skip(std::size_t bytes) { begin_ += bytes; }

  /// Offset of the next byte from the start of the file.
  [[nodiscard]] std::uint64_t position() const { return read_ - (end_ - begin_); }
  /// The size when the file was opened.
  [[nodiscard]] std::uint64_t size_bytes() const { return size_; }

 private:
  ForwardReader(ReadableFile file, std::uint64_t size)
      : file_(std::move(file)),
        size_(size),
        buffer_(size < kBufferBytes ? static_cast<std::size_t>(size) : kBufferBytes) {}

  ReadableFile file_;
  std::uint64_t size_ = 0;
  std::uint64_t read_ = 0;  ///< offset of the first byte that was not read yet
  std::vector<std::uint8_t> buffer_;
  std::size_t begin_ = 0;  ///< of the unread bytes in buffer_
  std::size_t end_ = 0;
};

}  // namespace overfly
