#include "server/logs/log_uploads.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <mutex>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/text/lower_case.hpp"
#include "core/text/shown_path.hpp"
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

/// Bytes of the files in a folder, and in its folders, that are no unfinished uploads.
std::uint64_t bytes_in(const fs::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code failed;
  for (fs::recursive_directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    std::error_code ignored;
    const bool part = entry->path().filename().string().starts_with(kPartPrefix);
    if (part || entry.depth() > 0) entry.disable_recursion_pending();
    if (part || !fs::is_regular_file(entry->symlink_status(ignored))) continue;
    const std::uintmax_t size = entry->file_size(ignored);
    if (!ignored) bytes += size;
  }
  return bytes;
}

void remove_part(const fs::path& part) {
  std::error_code ignored;
  fs::remove_all(part, ignored);
}

/// Removes a part whose upload no process receives any more: whoever receives it holds its lock.
void remove_if_abandoned(const fs::path& part) {
  const FileDescriptor file(::open(part.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (file.open() && ::flock(file.get(), LOCK_EX | LOCK_NB) == 0) remove_part(part);
}

/// Whether a part that was just created is locked now and still there: a server that starts in
/// between may have taken it for abandoned.
bool is_locked(const FileDescriptor& part) {
  struct stat status {};
  // File systems without locks have no second server's either.
  const bool own = ::flock(part.get(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
  return own && ::fstat(part.get(), &status) == 0 && status.st_nlink > 0;
}

Error exists_already(const UploadKind& kind, const fs::path& target) {
  return {ErrorCode::kConflict,
          kind.noun + " \"" + target.filename().string() + "\" exists already: delete it first"};
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

const UploadKind& log_upload_kind() {
  static const UploadKind kind{
      "log", log_extensions_text(), has_log_extension, [](const fs::path& file) -> Status {
        const auto format = flight::logs::detect_format(file);
        if (!format) return format.error();
        return {};
      }};
  return kind;
}

LogUpload::LogUpload(std::shared_ptr<Room> room, fs::path target, UploadKind kind)
    : room_(std::move(room)), kind_(std::move(kind)), target_(std::move(target)) {}

LogUpload::~LogUpload() {
  open_.close();
  if (!part_.empty()) remove_part(part_);
  const std::lock_guard lock(room_->mutex);
  room_->reserved_bytes -= reserved_bytes_;
  --room_->active;
}

/// @return false with errno
bool LogUpload::open_file(const fs::path& file) {
  open_ = FileDescriptor(
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644));
  return open_.open();
}

Status LogUpload::create_part(std::uint64_t number) {
  constexpr int kTries = 100;
  for (int i = 0; i < kTries; ++i) {
    const fs::path part =
        room_->folder / (std::string(kPartPrefix) + std::to_string(::getpid()) + "-" +
                         std::to_string(number) + (i > 0 ? "-" + std::to_string(i) : ""));
    const bool created = files_.empty() ? open_file(part) : ::mkdir(part.c_str(), 0755) == 0;
    if (!created) {
      // Another server, which may have the same process number in another container.
      if (errno == EEXIST) continue;
      return upload_error(part, "create");
    }
    if (!files_.empty()) {
      folder_ = FileDescriptor(::open(part.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    }
    const FileDescriptor& locked = files_.empty() ? open_ : folder_;
    if (!locked.open() || !is_locked(locked)) continue;
    part_ = part;
    return files_.empty() ? Status() : open_next_file();
  }
  errno = EEXIST;
  return upload_error(room_->folder / kPartPrefix, "create");
}

Status LogUpload::open_next_file() {
  open_.close();
  const UploadFile& file = files_[next_file_++];
  missing_bytes_ = file.size_bytes;
  const fs::path name = part_ / file.name;
  return open_file(name) ? Status() : upload_error(name, "create");
}

Status LogUpload::reserve(std::uint64_t bytes) {
  const UploadLimits& limits = room_->limits;
  if (bytes <= reserved_bytes_) return {};
  const std::uint64_t max_bytes = std::min(limits.max_bytes, kind_.max_bytes);
  if (bytes > max_bytes) {
    refusal_ = UploadRefusal::kTooLarge;
    return Error{ErrorCode::kConflict,
                 "the " + kind_.noun + " is larger than " + mib_text(max_bytes) +
                     ", the limit of one upload"};
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
    const std::uint64_t most = std::min(room_->limits.max_bytes, kind_.max_bytes);
    Status status = reserve(std::max(total, std::min(total + kReserveStep, most)));
    if (!status) status = reserve(total);
    if (!status) return status;
    refusal_ = UploadRefusal::kNone;
  }
  Status written = files_.empty() ? write_all(bytes) : write_to_files(bytes);
  if (written) written_bytes_ = total;
  return written;
}

Status LogUpload::write_all(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(open_.get(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return upload_error(target_, "write");
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return {};
}

Status LogUpload::write_to_files(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    if (missing_bytes_ == 0) {
      if (next_file_ == files_.size()) {
        return Error{ErrorCode::kInvalidArgument, "the body is longer than its files"};
      }
      if (Status status = open_next_file(); !status) return status;
      continue;
    }
    const std::size_t count = std::min<std::uint64_t>(bytes.size(), missing_bytes_);
    if (Status status = write_all(bytes.first(count)); !status) return status;
    missing_bytes_ -= count;
    bytes = bytes.subspan(count);
  }
  return {};
}

Result<fs::path> LogUpload::finish() { return files_.empty() ? finish_file() : finish_files(); }

Result<fs::path> LogUpload::finish_file() {
  if (const Status checked = kind_.check(part_); !checked) {
    refusal_ = UploadRefusal::kNotALog;
    return Error{ErrorCode::kUnreadable,
                 shown_without(part_, target_.filename().string(), checked.error().message)};
  }
  return take_target(target_);
}

Result<fs::path> LogUpload::finish_files() {
  while (missing_bytes_ == 0 && next_file_ < files_.size()) {
    if (Status status = open_next_file(); !status) return status.error();
  }
  if (missing_bytes_ > 0) {
    return Error{ErrorCode::kInvalidArgument, "the body is shorter than its files"};
  }
  if (Status status = check_uploaded_mapping(part_, files_); !status) {
    refusal_ = UploadRefusal::kNotALog;
    return status.error();
  }
  return take_target(target_ / files_.front().name);
}

/// @return the log
Result<fs::path> LogUpload::take_target(const fs::path& log) {
  const Result<bool> named = take_free_name(part_, target_);
  if (!named) return named.error();
  if (!*named) return exists_already(kind_, target_);
  part_.clear();
  open_.close();
  folder_.close();
  return log;
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
                                                     UploadRefusal& refusal,
                                                     const UploadKind& kind) const {
  const std::string shown = name.substr(0, 200);
  if (!is_plain_name(name) || !kind.has_extension(name)) {
    return Error{ErrorCode::kInvalidArgument,
                 "name = " + shown +
                     ": must be letters, digits, '_', '-' and '.', at most 200, and end with " +
                     "one of " + kind.extensions};
  }
  return begin_into(room_->folder / name, {}, size_bytes, refusal, kind);
}

Result<std::unique_ptr<LogUpload>> LogUploads::begin_set(const std::vector<UploadFile>& files,
                                                         UploadRefusal& refusal) const {
  if (Status status = check_upload_set(files, room_->limits.max_bytes); !status) {
    return status.error();
  }
  std::uint64_t total = 0;
  for (const UploadFile& file : files) total += file.size_bytes;
  const fs::path stem = fs::path(files.front().name).stem();
  if (stem == kCalibrationsFolder) {
    return Error{ErrorCode::kInvalidArgument,
                 "files: \"" + files.front().name +
                     "\": the name is that of the folder of "
                     "calibrations: must be another"};
  }
  return begin_into(room_->folder / stem, files, total, refusal, log_upload_kind());
}

Result<std::unique_ptr<LogUpload>> LogUploads::begin_into(const fs::path& target,
                                                          const std::vector<UploadFile>& files,
                                                          std::optional<std::uint64_t> size_bytes,
                                                          UploadRefusal& refusal,
                                                          const UploadKind& kind) const {
  if (room_->folder.empty() || room_->limits.quota_bytes == 0) {
    refusal = UploadRefusal::kOff;
    return Error{ErrorCode::kConflict, "this server takes no uploads"};
  }
  std::error_code failed;
  fs::create_directories(room_->folder, failed);
  if (failed) return Error{ErrorCode::kIo, room_->folder.string() + ": " + failed.message()};
  if (fs::exists(fs::symlink_status(target, failed))) return exists_already(kind, target);
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
    upload.reset(new LogUpload(room_, target, kind));
    ++room_->active;
    number = room_->next_part++;
  }
  upload->files_ = files;
  // Rejected by its size, it leaves no trace.
  if (Status status = upload->reserve(size_bytes.value_or(0)); !status) {
    refusal = upload->refusal();
    return status.error();
  }
  if (Status status = upload->create_part(number); !status) return status.error();
  return upload;
}

Status LogUploads::remove(const fs::path& file) const {
  std::error_code failed;
  const fs::path& own = room_->folder;
  const fs::path parent = file.parent_path();
  const auto is_own = [&](const fs::path& folder) {
    return !own.empty() && fs::equivalent(folder, own, failed);
  };
  const bool is_mapping = parent.filename() != kCalibrationsFolder &&
                          file.stem() == parent.filename() &&
                          lower_case(file.extension().string()) == ".json";
  if (is_own(parent.parent_path()) && is_mapping) {
    if (fs::remove_all(parent, failed) > 0 && !failed) return {};
    return Error{ErrorCode::kIo, parent.string() + ": cannot be deleted: " + failed.message()};
  }
  if (!is_own(parent)) {
    return Error{ErrorCode::kInvalidArgument,
                 "\"" + file.filename().string() + "\": only uploads can be deleted"};
  }
  if (::unlink(file.c_str()) != 0) {
    if (errno == ENOENT) {
      return Error{ErrorCode::kNotFound, "\"" + file.filename().string() + "\": no such upload"};
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
