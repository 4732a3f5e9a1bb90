#include "server/logs/log_uploads.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <mutex>
#include <string_view>
#include <system_error>
#include <utility>

#include "flight/logs/flight_log.hpp"
#include "server/files/plain_name.hpp"
#include "server/files/take_name.hpp"
#include "server/logs/log_places.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPartPrefix = ".upload-";
constexpr std::string_view kIndexSuffix = ".overfly-index";

Error upload_error(const fs::path& file, const std::string& what) {
  return {ErrorCode::kIo,
          file.string() + ": cannot " + what + ": " + std::generic_category().message(errno)};
}

std::string mib_text(std::uint64_t bytes) { return std::to_string(bytes >> 20U) + " MiB"; }

/// Bytes of the files in a folder that are no unfinished uploads.
std::uint64_t bytes_in(const fs::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    std::error_code ignored;
    if (entry->path().filename().string().starts_with(kPartPrefix)) continue;
    if (!fs::is_regular_file(entry->symlink_status(ignored))) continue;
    const std::uintmax_t size = entry->file_size(ignored);
    if (!ignored) bytes += size;
  }
  return bytes;
}

/// Removes a part whose upload no process receives any more: whoever receives it holds its lock.
void remove_if_abandoned(const fs::path& part) {
  const FileDescriptor file(::open(part.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (file.open() && ::flock(file.get(), LOCK_EX | LOCK_NB) == 0) ::unlink(part.c_str());
}

/// Creates a part and takes its lock. @param number  no other upload of this process has it
Result<std::pair<fs::path, FileDescriptor>> create_part(const fs::path& folder,
                                                        std::uint64_t number) {
  constexpr int kTries = 100;
  for (int i = 0; i < kTries; ++i) {
    const fs::path part =
        folder / (std::string(kPartPrefix) + std::to_string(::getpid()) + "-" +
                  std::to_string(number) + (i > 0 ? "-" + std::to_string(i) : ""));
    FileDescriptor file(
        ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644));
    if (!file.open()) {
      // Another server, which may have the same process number in another container.
      if (errno == EEXIST) continue;
      return upload_error(part, "create");
    }
    // A server that starts now may have taken it for abandoned, before it was locked.
    struct stat status {};
    const bool own = ::flock(file.get(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
    if (own && ::fstat(file.get(), &status) == 0 && status.st_nlink > 0) {
      return std::pair(part, std::move(file));
    }
  }
  errno = EEXIST;
  return upload_error(folder / kPartPrefix, "create");
}

}  // namespace

/// What all uploads of a server share.
struct LogUpload::Room {
  fs::path folder;
  UploadLimits limits;
  mutable std::mutex mutex;
  std::uint64_t reserved_bytes = 0;  ///< of uploads that are not finished
  std::size_t active = 0;
  std::uint64_t next_part = 0;
};

LogUpload::LogUpload(std::shared_ptr<Room> room, fs::path file, FileDescriptor part)
    : room_(std::move(room)), file_(std::move(file)), part_(std::move(part)) {}

LogUpload::~LogUpload() {
  part_.close();
  if (!part_file_.empty()) ::unlink(part_file_.c_str());
  const std::lock_guard lock(room_->mutex);
  room_->reserved_bytes -= reserved_bytes_;
  --room_->active;
}

Status LogUpload::reserve(std::uint64_t bytes) {
  const UploadLimits& limits = room_->limits;
  if (bytes <= reserved_bytes_) return {};
  if (bytes > limits.max_bytes) {
    refusal_ = UploadRefusal::kTooLarge;
    return Error{
        ErrorCode::kConflict,
        "the log is larger than " + mib_text(limits.max_bytes) + ", the limit of one upload"};
  }
  const std::lock_guard lock(room_->mutex);
  const std::uint64_t others = bytes_in(room_->folder) + room_->reserved_bytes - reserved_bytes_;
  if (others > limits.quota_bytes || bytes > limits.quota_bytes - others) {
    refusal_ = UploadRefusal::kQuota;
    return Error{ErrorCode::kConflict,
                 "the uploads would need more than " + mib_text(limits.quota_bytes) +
                     " (overfly serve --upload-quota): " + mib_text(others) +
                     " are taken; delete uploads that are not needed"};
  }
  room_->reserved_bytes += bytes - reserved_bytes_;
  reserved_bytes_ = bytes;
  return {};
}

Status LogUpload::write(std::span<const std::uint8_t> bytes) {
  constexpr std::uint64_t kReserveStep = std::uint64_t{16} << 20U;
  const std::uint64_t total = written_bytes_ + bytes.size();
  if (total > reserved_bytes_) {
    // In larger steps, because each counts the files of the folder. Near a limit: exactly.
    Status status =
        reserve(std::max(total, std::min(total + kReserveStep, room_->limits.max_bytes)));
    if (!status) status = reserve(total);
    if (!status) return status;
    refusal_ = UploadRefusal::kNone;
  }
  while (!bytes.empty()) {
    const ssize_t written = ::write(part_.get(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return upload_error(file_, "write");
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  written_bytes_ = total;
  return {};
}

Result<fs::path> LogUpload::finish() {
  if (const auto format = flight::logs::detect_format(part_file_); !format) {
    refusal_ = UploadRefusal::kNotALog;
    std::string message = format.error().message;
    const std::string own = part_file_.string();
    if (message.starts_with(own)) message = file_.filename().string() + message.substr(own.size());
    return Error{ErrorCode::kUnreadable, message};
  }
  const Result<bool> named = take_free_name(part_file_, file_);
  if (!named) return named.error();
  if (!*named) {
    return Error{ErrorCode::kConflict,
                 "log \"" + file_.filename().string() + "\" exists already: delete it first"};
  }
  part_file_.clear();
  part_.close();
  return file_;
}

LogUploads::LogUploads(const fs::path& folder, const UploadLimits& limits)
    : room_(std::make_shared<LogUpload::Room>()) {
  std::error_code failed;
  if (!folder.empty()) room_->folder = fs::absolute(folder, failed).lexically_normal();
  room_->limits = limits;
  for (fs::directory_iterator entry(room_->folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    const fs::path& file = entry->path();
    if (file.filename().string().starts_with(kPartPrefix)) remove_if_abandoned(file);
  }
}

Result<std::unique_ptr<LogUpload>> LogUploads::begin(const std::string& name,
                                                     std::optional<std::uint64_t> size_bytes,
                                                     UploadRefusal& refusal) const {
  const std::string shown = name.substr(0, 200);
  if (!is_plain_name(name) || !has_log_extension(name)) {
    return Error{ErrorCode::kInvalidArgument,
                 "name = " + shown +
                     ": must be letters, digits, '_', '-' and '.', at most 200, and end with " +
                     "one of " + log_extensions_text()};
  }
  if (room_->folder.empty() || room_->limits.quota_bytes == 0) {
    refusal = UploadRefusal::kOff;
    return Error{ErrorCode::kConflict, "this server takes no uploads"};
  }
  std::error_code failed;
  fs::create_directories(room_->folder, failed);
  if (failed) return Error{ErrorCode::kIo, room_->folder.string() + ": " + failed.message()};
  const fs::path file = room_->folder / name;
  if (fs::exists(fs::symlink_status(file, failed))) {
    return Error{ErrorCode::kConflict, "log \"" + shown + "\" exists already: delete it first"};
  }
  std::unique_ptr<LogUpload> upload;
  std::uint64_t number = 0;
  {
    const std::lock_guard lock(room_->mutex);
    if (room_->active >= room_->limits.max_parallel) {
      refusal = UploadRefusal::kBusy;
      return Error{ErrorCode::kConflict,
                   std::to_string(room_->active) + " uploads are being received, which is this " +
                       "server's limit: try again soon"};
    }
    upload.reset(new LogUpload(room_, file, FileDescriptor()));
    ++room_->active;
    number = room_->next_part++;
  }
  // Rejected by its size, it leaves no trace.
  if (Status status = upload->reserve(size_bytes.value_or(0)); !status) {
    refusal = upload->refusal();
    return status.error();
  }
  auto part = create_part(room_->folder, number);
  if (!part) return part.error();
  upload->part_file_ = std::move(part->first);
  upload->part_ = std::move(part->second);
  return upload;
}

Status LogUploads::remove(const fs::path& file) const {
  std::error_code failed;
  const bool uploaded =
      !room_->folder.empty() && fs::equivalent(file.parent_path(), room_->folder, failed);
  if (!uploaded) {
    return Error{ErrorCode::kInvalidArgument,
                 "log \"" + file.filename().string() + "\": only uploaded logs can be deleted"};
  }
  if (::unlink(file.c_str()) != 0) {
    if (errno == ENOENT) {
      return Error{ErrorCode::kNotFound, "log \"" + file.filename().string() + "\": no such log"};
    }
    return upload_error(file, "delete");
  }
  ::unlink((file.string() + std::string(kIndexSuffix)).c_str());
  return {};
}

std::uint64_t LogUploads::used_bytes() const {
  if (room_->folder.empty()) return 0;
  const std::lock_guard lock(room_->mutex);
  return bytes_in(room_->folder) + room_->reserved_bytes;
}

const UploadLimits& LogUploads::limits() const { return room_->limits; }

const fs::path& LogUploads::folder() const { return room_->folder; }

}  // namespace overfly::server
