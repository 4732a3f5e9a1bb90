#include "server/files/whole_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "core/outside/file_text.hpp"
#include "core/outside/outside_json.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

Error io_error(const fs::path& file, const char* action) {
  return {ErrorCode::kIo, file.string() + ": cannot " + action + ": " + std::strerror(errno)};
}

/// Writes all bytes, repeating partial writes.
bool write_all(int descriptor, const char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(descriptor, bytes, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

Status write_bytes(const fs::path& file, const char* bytes, std::size_t size) {
  const fs::path part = file.string() + ".part";
  // What is left of an earlier write, or a link or a FIFO in a folder that came from elsewhere.
  ::unlink(part.c_str());
  const int descriptor = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (descriptor < 0) return io_error(part, "create");
  const bool written = write_all(descriptor, bytes, size);
  const int write_errno = errno;
  if (::close(descriptor) != 0 || !written) {
    if (!written) errno = write_errno;
    Error error = io_error(part, "write");
    ::unlink(part.c_str());
    return error;
  }
  if (::rename(part.c_str(), file.c_str()) != 0) {
    Error error = io_error(file, "rename to");
    ::unlink(part.c_str());
    return error;
  }
  return {};
}

}  // namespace

Status write_whole(const fs::path& file, std::span<const std::uint8_t> bytes) {
  return write_bytes(file, reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

Status write_whole(const fs::path& file, const std::string& text) {
  return write_bytes(file, text.data(), text.size());
}

Status write_json(const fs::path& file, const nlohmann::json& value) {
  // External text may contain bytes that are not UTF-8: they are replaced instead of causing an
  // exception.
  return write_whole(file,
                     value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

Result<nlohmann::json> parse_json(std::string_view text, const std::string& origin) {
  return json_from_outside<nlohmann::json>(text, origin);
}

Result<nlohmann::json> read_json(const fs::path& file, std::uint64_t max_bytes) {
  const Result<std::string> text = read_file_text(file, max_bytes);
  if (!text) return text.error();
  return parse_json(*text, file.string());
}

AppendFile::AppendFile(int descriptor, fs::path file)
    : descriptor_(descriptor), file_(std::move(file)) {}

AppendFile::AppendFile(AppendFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), file_(std::move(other.file_)) {}

AppendFile& AppendFile::operator=(AppendFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(file_, other.file_);
  return *this;
}

AppendFile::~AppendFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<AppendFile> AppendFile::create(const fs::path& file) {
  const int descriptor =
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644);
  if (descriptor < 0) return io_error(file, "create");
  return AppendFile(descriptor, file);
}

Status AppendFile::append(std::span<const std::uint8_t> bytes) {
  return append(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

Status AppendFile::append(std::string_view text) {
  if (!write_all(descriptor_, text.data(), text.size())) return io_error(file_, "append to");
  return {};
}

Result<LineFile> LineFile::create(const fs::path& file) {
  Result<AppendFile> created = AppendFile::create(file);
  if (!created) return created.error();
  return LineFile(std::move(*created));
}

Status LineFile::append(const nlohmann::json& line) {
  return file_.append(line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

Status for_each_line(const fs::path& file,
                     const std::function<Status(const nlohmann::json&)>& take) {
  std::string line;  // what is there of it so far
  std::size_t row = 0;
  Status status;
  std::atomic<bool> failed = false;
  const auto take_line = [&]() -> Status {
    const std::string origin = file.string() + ", row " + std::to_string(++row);
    const Result<nlohmann::json> document = parse_json(line, origin);
    if (!document) return document.error();
    if (Status taken = take(*document); !taken) return taken.error().in(origin);
    return {};
  };
  const Status read = read_file_pieces(file, kMaxRowsBytes, &failed, [&](std::string_view piece) {
    while (status && !piece.empty()) {
      const std::size_t end = piece.find('\n');
      line += piece.substr(0, end);
      if (line.size() > kMaxRowBytes) {
        status = Error{ErrorCode::kUnreadable,
                       file.string() + ", row " + std::to_string(row + 1) + ": is longer than " +
                           std::to_string(kMaxRowBytes) + " bytes"};
      }
      if (end == std::string_view::npos) break;
      if (status) status = take_line();
      line.clear();
      piece.remove_prefix(end + 1);
    }
    failed = !status;
  });
  if (!status) return status;
  if (!read && read.error().code == ErrorCode::kNotFound) return {};
  return read;
}

Result<std::vector<nlohmann::json>> read_lines(const fs::path& file) {
  std::vector<nlohmann::json> lines;
  const Status status = for_each_line(file, [&](const nlohmann::json& line) -> Status {
    lines.push_back(line);
    return {};
  });
  if (!status) return status.error();
  return lines;
}

}  // namespace overfly::server
