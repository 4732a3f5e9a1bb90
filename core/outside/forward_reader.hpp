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

/// Bytes of a file, from `begin` up to `end`, which is not part of it.
struct FileRange {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
};

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
  /// Reads the bytes that lie `distance` behind position(), and stays there.
  /// @return how many there were: fewer than asked for at the end
  /// Errors: kIo.
  [[nodiscard]] Result<std::size_t> peek(std::uint64_t distance,
                                         std::span<std::uint8_t> bytes) const;
  /// Moves the position forward. @pre at most as many bytes as ahead() last returned
  void skip(std::size_t bytes) { begin_ += bytes; }

  /// Starts again, with these parts of the file as if they were one file: positions and sizes then
  /// count their bytes. Bytes behind the end of the file are left out. May be repeated.
  /// @pre in increasing order, without overlaps
  void only(std::vector<FileRange> parts);

  /// Offset of the next byte from the start of the file.
  [[nodiscard]] std::uint64_t position() const { return read_ - (end_ - begin_); }
  /// Offset of the next byte in the file, also where only parts of it are read.
  [[nodiscard]] std::uint64_t file_offset() const;
  /// The size when the file was opened.
  [[nodiscard]] std::uint64_t size_bytes() const { return size_; }

 private:
  /// Offset in the file of a position, and the bytes of its part from there on.
  [[nodiscard]] std::pair<std::uint64_t, std::uint64_t> place_of(std::uint64_t position) const;
  ForwardReader(ReadableFile file, std::uint64_t size)
      : file_(std::move(file)),
        file_end_(size),
        size_(size),
        parts_{{0, size}},
        buffer_(size < kBufferBytes ? static_cast<std::size_t>(size) : kBufferBytes) {}

  ReadableFile file_;
  std::uint64_t file_end_ = 0;  ///< the file's size when it was opened
  std::uint64_t size_ = 0;      ///< of all parts
  std::vector<FileRange> parts_;
  std::size_t part_ = 0;         ///< the one that is being read
  std::uint64_t part_read_ = 0;  ///< bytes of that part
  std::uint64_t read_ = 0;       ///< offset of the first byte that was not read yet
  std::vector<std::uint8_t> buffer_;
  std::size_t begin_ = 0;  ///< of the unread bytes in buffer_
  std::size_t end_ = 0;
};

}  // namespace overfly
