#include "server/frame_cache/frame_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <thread>

#include "core/outside/file_descriptor.hpp"
#include "core/time.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* kEnding = ".frame";
constexpr const char* kPartEnding = ".part";
/// A file that has been in the writing for so long was left by a process that was killed.
constexpr std::int64_t kLongestWriting_ns = 60 * kNsPerS;
/// Part of the budget that is freed at once, so that the folder is not searched for each picture.
constexpr std::uint64_t kFreedShare = 16;
constexpr std::chrono::seconds kSearchPause{10};
constexpr std::chrono::milliseconds kLongestLockWait{200};

Error folder_error(const fs::path& file, const char* action) {
  return {ErrorCode::kIo,
          file.string() + ": cannot " + action + ": " + std::generic_category().message(errno)};
}

/// The number of bytes in the folder, locked by flock(2) while it is changed.
class Ledger {
 public:
  /// Empty if another process holds it too long.
  static Result<std::optional<Ledger>> lock(const fs::path& folder) {
    const fs::path file = folder / "ledger";
    FileDescriptor descriptor(
        ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644));
    if (!descriptor.open()) return folder_error(file, "open");
    const Clock::time_point end = Clock::now() + kLongestLockWait;
    while (::flock(descriptor.get(), LOCK_EX | LOCK_NB) != 0) {
      if (errno != EWOULDBLOCK && errno != EINTR) return folder_error(file, "lock");
      if (Clock::now() > end) return std::optional<Ledger>();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return std::optional<Ledger>(Ledger(std::move(descriptor), file));
  }

  /// Empty if it is new or damaged.
  [[nodiscard]] std::optional<std::uint64_t> used_bytes() const {
    std::uint64_t values[2] = {};
    if (::pread(descriptor_.get(), values, sizeof values, 0) != sizeof values) return std::nullopt;
    if (values[1] != ~values[0]) return std::nullopt;
    return values[0];
  }
  Status set_used_bytes(std::uint64_t used_bytes) const {
    const std::uint64_t values[2] = {used_bytes, ~used_bytes};
    if (::pwrite(descriptor_.get(), values, sizeof values, 0) == sizeof values) return {};
    return folder_error(file_, "write");
  }

 private:
  Ledger(FileDescriptor descriptor, fs::path file)
      : descriptor_(std::move(descriptor)), file_(std::move(file)) {}

  FileDescriptor descriptor_;
  fs::path file_;
};

struct PictureFile {
  fs::path file;
  std::uint64_t bytes = 0;
  std::int64_t used_ns = 0;
};

struct Contents {
  std::uint64_t bytes = 0;
  std::vector<PictureFile> pictures;
};

std::int64_t unix_now_ns() {
  return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

bool is_part(const std::string& name) {
  return name.find(kEnding) != std::string::npos && name.ends_with(kPartEnding);
}

/// All pictures; files that were left in the writing are removed.
Contents contents_of(const fs::path& folder) {
  Contents found;
  std::error_code error;
  for (auto entry = fs::recursive_directory_iterator(folder, error);
       !error && entry != fs::recursive_directory_iterator();
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.ends_with(kEnding) && !is_part(name)) continue;
    struct stat state {};
    if (::lstat(entry->path().c_str(), &state) != 0 || !S_ISREG(state.st_mode)) continue;
    const std::int64_t used_ns =
        static_cast<std::int64_t>(state.st_mtim.tv_sec) * kNsPerS + state.st_mtim.tv_nsec;
    if (is_part(name) && unix_now_ns() - used_ns > kLongestWriting_ns) {
      ::unlink(entry->path().c_str());
      continue;
    }
    found.bytes += static_cast<std::uint64_t>(state.st_size);
    if (is_part(name)) continue;
    found.pictures.push_back({entry->path(), static_cast<std::uint64_t>(state.st_size), used_ns});
  }
  return found;
}

/// Removes pictures until at most `most_bytes` are left, those used longest ago first.
/// @return the bytes that are left
std::uint64_t shrink(Contents contents, std::uint64_t most_bytes, std::int64_t keep_since_ns) {
  std::sort(contents.pictures.begin(),
            contents.pictures.end(),
            [](const PictureFile& a, const PictureFile& b) { return a.used_ns < b.used_ns; });
  for (const PictureFile& entry : contents.pictures) {
    if (contents.bytes <= most_bytes || entry.used_ns >= keep_since_ns) break;
    if (::unlink(entry.file.c_str()) == 0 || errno == ENOENT) contents.bytes -= entry.bytes;
  }
  return contents.bytes;
}

bool write_picture_bytes(int descriptor, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

/// Of a file that no other thread or process writes.
fs::path unwritten_name(const fs::path& file) {
  static std::atomic<std::uint64_t> number{0};
  return file.string() + "." + std::to_string(::getpid()) + "-" + std::to_string(number++) +
         kPartEnding;
}

}  // namespace

Status FrameFolder::create() const {
  std::error_code error;
  fs::create_directories(options_.folder, error);
  if (error) {
    return Error{ErrorCode::kIo, options_.folder.string() + ": cannot create: " + error.message()};
  }
  // Programs that make backups leave such folders out (bford.info/cachedir).
  constexpr const char* kTag = "Signature: 8a477f597d28d172789f06886806bc55\n";
  const fs::path tag = options_.folder / "CACHEDIR.TAG";
  const FileDescriptor file(::open(tag.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
  if (!file.open() && errno != EEXIST) return folder_error(tag, "create");
  if (file.open()) {
    const std::string_view text(kTag);
    write_picture_bytes(file.get(),
                        {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  return {};
}

fs::path FrameFolder::file_of(const std::string& key) const {
  return options_.folder / key.substr(0, 2) / (key.substr(2) + kEnding);
}

Result<std::optional<std::vector<std::uint8_t>>> FrameFolder::read(const std::string& key,
                                                                   std::size_t max_bytes) const {
  const fs::path file = file_of(key);
  // Without waiting, should it be a pipe.
  const FileDescriptor descriptor(
      ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  if (!descriptor.open() && (errno == ENOENT || errno == ENOTDIR)) {
    return std::optional<std::vector<std::uint8_t>>();
  }
  if (!descriptor.open()) return folder_error(file, "open");
  struct stat state {};
  if (::fstat(descriptor.get(), &state) != 0) return folder_error(file, "read");
  const auto size = static_cast<std::uint64_t>(state.st_size);
  if (!S_ISREG(state.st_mode) || size > max_bytes) {
    return Error{ErrorCode::kUnreadable, file.string() + ": is damaged"};
  }
  std::vector<std::uint8_t> bytes(size);
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t got = ::read(descriptor.get(), bytes.data() + filled, bytes.size() - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return folder_error(file, "read");
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
  }
  bytes.resize(filled);
  // Its time of modification is that of its last use.
  (void)::futimens(descriptor.get(), nullptr);
  return std::optional(std::move(bytes));
}

Status FrameFolder::check_disk(std::uint64_t size) const {
  struct statvfs disk {};
  if (::statvfs(options_.folder.c_str(), &disk) != 0) {
    return folder_error(options_.folder, "find the space that is left on its disk");
  }
  const std::uint64_t free_bytes = std::uint64_t{disk.f_bavail} * disk.f_frsize;
  if (free_bytes >= options_.least_free_bytes + size) return {};
  return Error{ErrorCode::kIo,
               options_.folder.string() + ": only " + std::to_string(free_bytes >> 20U) +
                   " MiB are left on its disk, and " +
                   std::to_string(options_.least_free_bytes >> 20U) + " MiB must stay free"};
}

Result<FrameFolder::Added> FrameFolder::reserve(std::uint64_t size,
                                                const fs::path& part,
                                                FileDescriptor& file) {
  const std::uint64_t budget_bytes = options_.budget_bytes;
  if (size > budget_bytes || Clock::now() < search_again_) return Added::kNoRoom;
  const Result<std::optional<Ledger>> ledger = Ledger::lock(options_.folder);
  if (!ledger) return ledger.error();
  if (!*ledger) return Added::kBusy;
  const std::optional<std::uint64_t> known = (*ledger)->used_bytes();
  std::uint64_t used_bytes = known.value_or(budget_bytes);
  const std::uint64_t most_bytes = budget_bytes - size;
  if (used_bytes > most_bytes) {
    Contents contents = contents_of(options_.folder);
    used_bytes = contents.bytes;
    if (used_bytes > most_bytes) {
      const std::uint64_t freed_bytes = std::min(most_bytes, budget_bytes / kFreedShare);
      used_bytes = shrink(std::move(contents), most_bytes - freed_bytes, options_.keep_since_ns);
    }
  }
  if (Status status = check_disk(size); !status) return status.error();
  const bool fits = used_bytes <= most_bytes;
  Status entered = (*ledger)->set_used_bytes(used_bytes + (fits ? size : 0));
  if (!entered) return entered.error();
  if (!fits) {
    search_again_ = Clock::now() + kSearchPause;
    return Added::kNoRoom;
  }
  // With its full size, so that others count it.
  file = FileDescriptor(::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
  if (!file.open()) return folder_error(part, "create");
  if (::ftruncate(file.get(), static_cast<off_t>(size)) != 0) {
    const Error error = folder_error(part, "write");
    ::unlink(part.c_str());
    return error;
  }
  return Added::kAdded;
}

Result<FrameFolder::Added> FrameFolder::add(const std::string& key,
                                            std::span<const std::uint8_t> bytes) {
  const fs::path file = file_of(key);
  if (is_known(key)) return Added::kKnown;
  if (::mkdir(file.parent_path().c_str(), 0755) != 0 && errno != EEXIST) {
    return folder_error(file.parent_path(), "create");
  }
  const fs::path part = unwritten_name(file);
  FileDescriptor descriptor;
  const Result<Added> reserved = reserve(bytes.size(), part, descriptor);
  if (!reserved || *reserved != Added::kAdded) return reserved;
  const bool written = write_picture_bytes(descriptor.get(), bytes);
  if (!written || ::rename(part.c_str(), file.c_str()) != 0) {
    const Error error = folder_error(file, "write");
    ::unlink(part.c_str());
    return error;
  }
  return Added::kAdded;
}

bool FrameFolder::is_known(const std::string& key) const {
  return ::access(file_of(key).c_str(), F_OK) == 0;
}

void FrameFolder::remove(const std::string& key) const { ::unlink(file_of(key).c_str()); }

}  // namespace overfly::server
