// Receives flight logs from clients into one folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/outside/file_descriptor.hpp"
#include "core/result.hpp"

namespace overfly::server {

struct UploadLimits {
  std::uint64_t quota_bytes = std::uint64_t{4} << 30U;  ///< all uploads together; 0 = no uploads
  std::uint64_t max_bytes = std::uint64_t{2} << 30U;    ///< one upload
  std::size_t max_parallel = 4;
};

/// Why an upload is refused, in addition to its error.
enum class UploadRefusal { kNone, kOff, kBusy, kTooLarge, kQuota, kNotALog };

/// A log that is being received. Its destructor removes what was received, unless it is finished.
class LogUpload {
 public:
  ~LogUpload();
  LogUpload(const LogUpload&) = delete;
  LogUpload& operator=(const LogUpload&) = delete;

  /// Appends bytes. Errors: kConflict with refusal() where a limit is reached; kIo.
  [[nodiscard]] Status write(std::span<const std::uint8_t> bytes);
  /// Gives the file its name.
  /// @return the file
  /// Errors: kUnreadable with kNotALog if its first bytes have no known format; kConflict if a log
  /// with this name has come in the meantime; kIo.
  [[nodiscard]] Result<std::filesystem::path> finish();
  [[nodiscard]] UploadRefusal refusal() const { return refusal_; }

 private:
  friend class LogUploads;
  struct Room;
  LogUpload(std::shared_ptr<Room> room, std::filesystem::path file, FileDescriptor part);
  [[nodiscard]] Status reserve(std::uint64_t bytes);

  std::shared_ptr<Room> room_;
  std::filesystem::path file_;
  std::filesystem::path part_file_;
  FileDescriptor part_;
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
  /// @param name        of the file: a plain name with an extension of flight logs
  /// @param size_bytes  if it is known in advance
  /// Errors: kInvalidArgument for the name; kConflict if it exists, or with `refusal`; kIo.
  [[nodiscard]] Result<std::unique_ptr<LogUpload>> begin(const std::string& name,
                                                         std::optional<std::uint64_t> size_bytes,
                                                         UploadRefusal& refusal) const;
  /// Deletes an upload and its index. Errors: kNotFound; kInvalidArgument for a log that was not
  /// uploaded.
  [[nodiscard]] Status remove(const std::filesystem::path& file) const;
  /// Bytes of all uploads, with those that are being received.
  [[nodiscard]] std::uint64_t used_bytes() const;
  [[nodiscard]] const UploadLimits& limits() const;
  [[nodiscard]] const std::filesystem::path& folder() const;

 private:
  std::shared_ptr<LogUpload::Room> room_;
};

}  // namespace overfly::server
