#include "core/outside/forward_reader.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace overfly {

Result<ForwardReader> ForwardReader::open(const std::filesystem::path& file) {
  Result<ReadableFile> opened = ReadableFile::open(file);
  if (!opened) return opened.error();
  const Result<std::uint64_t> size = opened->size_bytes();
  if (!size) return size.error();
  return ForwardReader(std::move(opened).value(), *size);
}

Result<std::span<const std::uint8_t>> ForwardReader::ahead(std::size_t wanted) {
  assert(wanted <= kBufferBytes);
  if (end_ - begin_ < wanted && read_ < size_) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
    while (end_ < buffer_.size() && read_ < size_) {
      const std::uint64_t offset = parts_[part_].begin + part_read_;
      const std::uint64_t left = parts_[part_].end - offset;
      const std::size_t most = std::min<std::uint64_t>(buffer_.size() - end_, left);
      const Result<std::size_t> got =
          file_.read_some(offset, std::span(buffer_).subspan(end_, most));
      if (!got) return got.error();
      if (*got == 0) size_ = read_;  // The file was shortened.
      end_ += *got;
      read_ += *got;
      part_read_ += *got;
      if (part_read_ == parts_[part_].end - parts_[part_].begin && part_ + 1 < parts_.size()) {
        ++part_;
        part_read_ = 0;
      }
    }
  }
  return std::span<const std::uint8_t>(buffer_).subspan(begin_, end_ - begin_);
}

void ForwardReader::only(std::vector<FileRange> parts) {
  size_ = 0;
  parts_.clear();
  for (FileRange part : parts) {
    part.end = std::min(part.end, file_end_);
    if (part.begin >= part.end) continue;
    size_ += part.end - part.begin;
    parts_.push_back(part);
  }
  if (parts_.empty()) parts_.push_back({file_end_, file_end_});
  part_ = 0;
  part_read_ = read_ = 0;
  begin_ = end_ = 0;
}

std::pair<std::uint64_t, std::uint64_t> ForwardReader::place_of(std::uint64_t position) const {
  for (const FileRange& part : parts_) {
    const std::uint64_t bytes = part.end - part.begin;
    if (position < bytes) return {part.begin + position, bytes - position};
    position -= bytes;
  }
  return {parts_.back().end, 0};
}

Result<std::size_t> ForwardReader::peek(std::uint64_t distance,
                                        std::span<std::uint8_t> bytes) const {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const auto [offset, left] = place_of(position() + distance + done);
    const std::size_t most = std::min<std::uint64_t>(bytes.size() - done, left);
    if (most == 0) break;
    const Result<std::size_t> got = file_.read_some(offset, bytes.subspan(done, most));
    if (!got) return got;
    if (*got == 0) break;
    done += *got;
  }
  return done;
}

std::uint64_t ForwardReader::file_offset() const { return place_of(position()).first; }

}  // namespace overfly
