#include "core/outside/file_text.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/cancel.hpp"

namespace overfly {
namespace {

int open_for_reading(const std::filesystem::path& file) {
  return ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
}

Error system_error(const std::filesystem::path& file, const char* action) {
  const int reason = errno;
  if (reason == ENOENT || reason == ENOTDIR) {
    return {ErrorCode::kNotFound, file.string() + ": no such file"};
  }
  return {ErrorCode::kIo, file.string() + ": " + action + ": " + std::strerror(reason)};
}

Status check_kind(const struct stat& facts, const std::filesystem::path& file) {
  if (S_ISREG(facts.st_mode)) return {};
  const char* const what =
      S_ISDIR(facts.st_mode) ? ": is a folder, not a file" : ": is not a regular file";
  return Error{ErrorCode::kUnreadable, file.string() + what};
}

Error too_long(const std::filesystem::path& file, const std::string& bytes, std::uint64_t limit) {
  return {ErrorCode::kUnreadable,
          file.string() + ": has " + bytes + " bytes: must have at most " + std::to_string(limit)};
}

}  // namespace

Status check_regular_file(const std::filesystem::path& file) {
  struct stat facts {};
  if (::stat(file.c_str(), &facts) != 0) return system_error(file, "cannot be opened for reading");
  return check_kind(facts, file);
}

Result<ReadableFile> ReadableFile::open(const std::filesystem::path& file) {
  // Check before opening: opening some devices has side effects.
  if (Status status = check_regular_file(file); !status) return status.error();
  ReadableFile opened(open_for_reading(file), file);
  struct stat facts {};
  if (opened.descriptor_ < 0 || ::fstat(opened.descriptor_, &facts) != 0) {
    return system_error(file, "cannot be opened for reading");
  }
  if (Status status = check_kind(facts, file); !status) return status.error();
  return opened;
}

ReadableFile::~ReadableFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

ReadableFile::ReadableFile(ReadableFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), file_(std::move(other.file_)) {}

ReadableFile& ReadableFile::operator=(ReadableFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(file_, other.file_);
  return *this;
}

Result<std::uint64_t> ReadableFile::size_bytes() const {
  struct stat facts {};
  if (::fstat(descriptor_, &facts) != 0) return system_error(file_, "its size cannot be read");
  return static_cast<std::uint64_t>(facts.st_size);
}

Result<std::size_t> ReadableFile::read_some(std::uint64_t offset,
                                            std::span<std::uint8_t> bytes) const {
  while (true) {
    const ssize_t got =
        ::pread(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno != EINTR) return system_error(file_, "reading failed");
  }
}

Status ReadableFile::read_at(std::uint64_t offset, std::span<std::uint8_t> bytes) const {
  while (!bytes.empty()) {
    const Result<std::size_t> got = read_some(offset, bytes);
    if (!got) return got.error();
    if (*got == 0) {
      return Error{ErrorCode::kIo,
                   file_.string() + ": ends at byte " + std::to_string(offset) + ", " +
                       std::to_string(bytes.size()) + " bytes too early"};
    }
    bytes = bytes.subspan(*got);
    offset += *got;
  }
  return {};
}

Status read_file_pieces(const std::filesystem::path& file,
                        std::uint64_t max_bytes,
                        const std::atomic<bool>* cancel,
                        const std::function<void(std::string_view)>& take) {
  const Result<ReadableFile> open = ReadableFile::open(file);
  if (!open) return open.error();
  const Result<std::uint64_t> size = open->size_bytes();
  if (!size) return size.error();
  if (*size > max_bytes) return too_long(file, std::to_string(*size), max_bytes);

  constexpr std::uint64_t kPieceBytes = std::uint64_t{1} << 20U;
  std::vector<std::uint8_t> piece(std::min(kPieceBytes, std::max<std::uint64_t>(*size, 4095) + 1));
  for (std::uint64_t total = 0; true;) {
    if (is_cancelled(cancel)) {
      return Error{ErrorCode::kCancelled, file.string() + ": reading was cancelled"};
    }
    const Result<std::size_t> got = open->read_some(total, piece);
    if (!got) return got.error();
    if (*got == 0) return {};
    total += *got;
    if (total > max_bytes) return too_long(file, "over " + std::to_string(max_bytes), max_bytes);
    take({reinterpret_cast<const char*>(piece.data()), *got});
  }
}

Result<std::string> read_file_text(const std::filesystem::path& file,
                                   std::uint64_t max_bytes,
                                   const std::atomic<bool>* cancel) {
  std::string text;
  const Status status =
      read_file_pieces(file, max_bytes, cancel, [&](std::string_view piece) { text += piece; });
  if (!status) return status.error();
  return text;
}

Result<std::vector<std::uint8_t>> read_file_bytes(const std::filesystem::path& file,
                                                  std::uint64_t max_bytes) {
  std::vector<std::uint8_t> bytes;
  const Status status = read_file_pieces(file, max_bytes, nullptr, [&](std::string_view piece) {
    bytes.insert(bytes.end(), piece.begin(), piece.end());
  });
  if (!status) return status.error();
  return bytes;
}

}  // namespace overfly
