#include "core/file_text.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/cancel.hpp"

namespace overfly {
namespace {

/// Closes its file descriptor on destruction.
class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& file)
      : descriptor_(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY)) {}
  ~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

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

Status read_file_pieces(const std::filesystem::path& file,
                        std::uint64_t max_bytes,
                        const std::atomic<bool>* cancel,
                        const std::function<void(std::string_view)>& take) {
  // Check before opening: opening some devices has side effects.
  if (Status status = check_regular_file(file); !status) return status;
  const OpenFile open(file);
  struct stat facts {};
  if (open.descriptor() < 0 || ::fstat(open.descriptor(), &facts) != 0) {
    return system_error(file, "cannot be opened for reading");
  }
  if (Status status = check_kind(facts, file); !status) return status;
  const auto size = static_cast<std::uint64_t>(facts.st_size);
  if (size > max_bytes) return too_long(file, std::to_string(size), max_bytes);

  constexpr std::uint64_t kPieceBytes = std::uint64_t{1} << 20U;
  std::string piece(std::min(kPieceBytes, std::max<std::uint64_t>(size, 4095) + 1), '\0');
  for (std::uint64_t total = 0; true;) {
    if (is_cancelled(cancel)) {
      return Error{ErrorCode::kCancelled, file.string() + ": reading was cancelled"};
    }
    const ssize_t got = ::read(open.descriptor(), piece.data(), piece.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return system_error(file, "reading failed");
    if (got == 0) return {};
    total += static_cast<std::uint64_t>(got);
    if (total > max_bytes) return too_long(file, "over " + std::to_string(max_bytes), max_bytes);
    take(std::string_view(piece).substr(0, static_cast<std::size_t>(got)));
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
