// Files written whole or not at all, and files that are only appended to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/result.hpp"

namespace overfly::server {

/// Writes a temporary file next to the target and renames it. Errors: kIo naming the file and the
/// system's reason.
[[nodiscard]] Status write_whole(const std::filesystem::path& file,
                                 std::span<const std::uint8_t> bytes);
[[nodiscard]] Status write_whole(const std::filesystem::path& file, const std::string& text);
/// Indented by two spaces, with a line feed at the end.
[[nodiscard]] Status write_json(const std::filesystem::path& file, const nlohmann::json& value);

/// Limit for a document; enough for the timings of a day's flight.
inline constexpr std::uint64_t kMaxDocumentBytes = std::uint64_t{256} << 20U;
/// Limit for a file of rows, which are kept in memory: at 31 Hz for several days, at 1000 Hz with
/// covariances for two hours.
inline constexpr std::uint64_t kMaxRowsBytes = std::uint64_t{8} << 30U;
/// Limit for a row of a file; many times one with covariance and counters.
inline constexpr std::uint64_t kMaxRowBytes = std::uint64_t{1} << 20U;

/// Errors: as read_file_text; kUnreadable naming file, line and column, or the limit of its depth.
[[nodiscard]] Result<nlohmann::json> read_json(const std::filesystem::path& file,
                                               std::uint64_t max_bytes = kMaxDocumentBytes);
/// Parses text that was read from `origin`, as json_from_outside.
[[nodiscard]] Result<nlohmann::json> parse_json(std::string_view text, const std::string& origin);

/// A file that only grows. Each piece reaches the system in one write.
class AppendFile {
 public:
  /// Creates the file; must not exist. Errors: kIo.
  static Result<AppendFile> create(const std::filesystem::path& file);
  ~AppendFile();
  AppendFile(AppendFile&& other) noexcept;
  AppendFile& operator=(AppendFile&& other) noexcept;

  /// Errors: kIo naming the file.
  Status append(std::span<const std::uint8_t> bytes);
  Status append(std::string_view text);

 private:
  AppendFile(int descriptor, std::filesystem::path file);
  int descriptor_ = -1;
  std::filesystem::path file_;
};

/// A file with one JSON document a line. Each line reaches the system in one write, so a process
/// that is killed leaves at most the last line truncated.
class LineFile {
 public:
  /// Creates the file; must not exist. Errors: kIo.
  static Result<LineFile> create(const std::filesystem::path& file);
  Status append(const nlohmann::json& line);

 private:
  explicit LineFile(AppendFile file) : file_(std::move(file)) {}
  AppendFile file_;
};

/// Reads such a file and passes each line to `take`, so that only one document is in memory. A last
/// line without line feed is the remains of a kill and is skipped. An absent file has no lines.
/// Errors: as read_file_text; kUnreadable naming file and row; those of `take`, with file and row.
[[nodiscard]] Status for_each_line(const std::filesystem::path& file,
                                   const std::function<Status(const nlohmann::json&)>& take);
/// All lines of such a file. Errors: as for_each_line.
[[nodiscard]] Result<std::vector<nlohmann::json>> read_lines(const std::filesystem::path& file);

}  // namespace overfly::server
