// Receives flight logs and trajectory files from clients into one folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/outside/file_descriptor.hpp"
#include "core/result.hpp"
#include "server/logs/upload_set.hpp"

namespace overfly::server {

/// Folder in that of the uploads for saved calibrations; no set of uploaded files has this name.
inline constexpr const char* kCalibrationsFolder = "calibrations";

struct UploadLimits {
  std::uint64_t quota_bytes = std::uint64_t{4} << 30U;  ///< all uploads together; 0 = no uploads
  std::uint64_t max_bytes = std::uint64_t{2} << 30U;    ///< one upload
  std::size_t max_parallel = 4;
};

/// What an uploaded file must be.
struct UploadKind {
  std::string noun;        ///< in messages: "log"
  std::string extensions;  ///< in messages: ".bin, .ulg"
  std::function<bool(const std::string& name)> has_extension;
  /// Errors: kUnreadable naming the file.
  std::function<Status(const std::filesystem::path&)> check;
  std::uint64_t max_bytes = UINT64_MAX;  ///< of one upload, in addition to UploadLimits
};
[[nodiscard]] const UploadKind& log_upload_kind();

/// Why an upload is refused, in addition to its error.
enum class UploadRefusal { kNone, kOff, kBusy, kTooLarge, kQuota, kNotALog };

/// A file that is being received. Its destructor removes what was received, unless it is finished.
class LogUpload {
 public:
  ~LogUpload();
  LogUpload(const LogUpload&) = delete;
  LogUpload& operator=(const LogUpload&) = delete;

  /// Appends bytes; of several files, those of one follow those of the file before it.
  /// Errors: kConflict with refusal() where a limit is reached; kInvalidArgument for more bytes
  /// than were announced for the files; kIo.
  [[nodiscard]] Status write(std::span<const std::uint8_t> bytes);
  /// Gives the file its name, or several files their folder.
  /// @return the file, or the mapping
  /// Errors: as UploadKind::check, with kNotALog, also if a mapping
  /// names other files than those that came with it; kInvalidArgument for fewer bytes than were
  /// announced; kConflict if a log with this name has come in the meantime; kIo.
  [[nodiscard]] Result<std::filesystem::path> finish();
  [[nodiscard]] UploadRefusal refusal() const { return refusal_; }

 private:
  friend class LogUploads;
  struct Room;
  LogUpload(std::shared_ptr<Room> room, std::filesystem::path target, UploadKind kind);
  [[nodiscard]] Status reserve(std::uint64_t bytes);
  [[nodiscard]] Status create_part(std::uint64_t number);
  [[nodiscard]] bool open_file(const std::filesystem::path& file);
  [[nodiscard]] Status write_all(std::span<const std::uint8_t> bytes);
  [[nodiscard]] Status write_to_files(std::span<const std::uint8_t> bytes);
  [[nodiscard]] Status open_next_file();
  [[nodiscard]] Result<std::filesystem::path> finish_file();
  [[nodiscard]] Result<std::filesystem::path> finish_files();
  [[nodiscard]] Result<std::filesystem::path> take_target(const std::filesystem::path& log);

  std::shared_ptr<Room> room_;
  UploadKind kind_;
  std::filesystem::path target_;     ///< the log's file; of several files, their folder
  std::filesystem::path part_;       ///< the same while it is received
  std::vector<UploadFile> files_;    ///< empty: one file of any size
  std::size_t next_file_ = 0;        ///< of files_: the first that was not begun
  std::uint64_t missing_bytes_ = 0;  ///< of the file that was begun last
  FileDescriptor open_;              ///< the file that is written
  FileDescriptor folder_;  ///< of several files; like a single file it is locked until the end
  std::uint64_t reserved_bytes_ = 0;
  std::uint64_t written_bytes_ = 0;
  UploadRefusal refusal_ = UploadRefusal::kNone;
};

/// Thread-safe.
class LogUploads {
 public:
  /// Removes what uploads that were not finished have left there, but not those that another server
  /// is receiving.
  /// @param folder  created with the first upload; empty = uploads are refused
  LogUploads(const std::filesystem::path& folder, const UploadLimits& limits);

  /// Begins an upload.
  /// @param name        of the file: a plain name with an extension of its kind
  /// @param size_bytes  if it is known in advance
  /// Errors: kInvalidArgument for the name; kConflict if it exists, or with `refusal`; kIo.
  [[nodiscard]] Result<std::unique_ptr<LogUpload>> begin(const std::string& name,
                                                         std::optional<std::uint64_t> size_bytes,
                                                         UploadRefusal& refusal,
                                                         const UploadKind& kind) const;
  /// Begins an upload of a mapping of CSV files with its pieces, into a folder named like the
  /// mapping.
  /// @param files  the mapping first; with plain names: one .json file, the others .csv or .txt
  /// Errors: kInvalidArgument for names, sizes and their number; as begin.
  [[nodiscard]] Result<std::unique_ptr<LogUpload>> begin_set(const std::vector<UploadFile>& files,
                                                             UploadRefusal& refusal) const;
  /// Deletes an upload and its index, a mapping with its folder. Errors: kNotFound;
  /// kInvalidArgument for a log that was not uploaded.
  [[nodiscard]] Status remove(const std::filesystem::path& file) const;
  /// Bytes of all uploads, with those that are being received.
  [[nodiscard]] std::uint64_t used_bytes() const;
  [[nodiscard]] const UploadLimits& limits() const;
  [[nodiscard]] const std::filesystem::path& folder() const;

 private:
  [[nodiscard]] Result<std::unique_ptr<LogUpload>> begin_into(
      const std::filesystem::path& target,
      const std::vector<UploadFile>& files,
      std::optional<std::uint64_t> size_bytes,
      UploadRefusal& refusal,
      const UploadKind& kind) const;

  std::shared_ptr<LogUpload::Room> room_;
};

}  // namespace overfly::server
