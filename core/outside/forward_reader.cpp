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
      const std::size_t most = std::min<std::uint64_t>(buffer_.size() - end_, size_ - read_);
      const Result<std::size_t> got =
          file_.read_some(read_, std::span(buffer_).subspan(end_, most));
      if (!got) return got.error();
      if (*got == 0) size_ = read_;  // The file was shortened.
      end_ += *got;
      read_ += *got;
    }
  }
  return std::span<const std::uint8_t>(buffer_).subspan(begin_, end_ - begin_);
}

}  // namespace overfly
