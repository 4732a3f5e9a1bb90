// Reads text files of numbers: splits lines into fields and reports errors with file, line and
// column.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace overfly {

/// One line that is neither empty nor a comment. If it contains a comma it is split at commas,
/// otherwise at white space. Fields are trimmed.
struct FieldLine {
  int number = 0;  ///< line number in the file, from 1
  bool comma_separated = false;
  std::vector<std::string_view> fields;
};

enum class TimeUnit { kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };

class FieldFile {
 public:
  static constexpr std::uint64_t kMaxBytes = std::uint64_t{256} << 20U;
  static constexpr std::size_t kMaxLines = 4'000'000;  ///< five hours at 200 Hz

  struct Limits {
    std::uint64_t max_bytes = kMaxBytes;
    std::size_t max_lines = kMaxLines;  ///< without empty lines and comments
  };
  static constexpr std::size_t kMaxLineFields = 4096;
  static constexpr std::size_t kMeanLineFields = 32;  ///< at most so many in each of max_lines
  static constexpr std::size_t kMaxComments = 1000;   ///< keys that are kept

  /// @param cancel  may be null
  /// Errors: as read_file_text; kUnreadable beyond the limits.
  static Result<FieldFile> read(const std::filesystem::path& file,
                                const std::atomic<bool>* cancel = nullptr);
  static Result<FieldFile> read(const std::filesystem::path& file,
                                const std::atomic<bool>* cancel,
                                const Limits& limits);
  /// The complete lines within the first bytes of a file of any size.
  /// Errors: as ReadableFile::open; kIo.
  static Result<FieldFile> read_start(const std::filesystem::path& file, std::size_t bytes);

  [[nodiscard]] const std::vector<FieldLine>& lines() const { return lines_; }
  /// Comments of the form `# key value`; the last value of each key.
  [[nodiscard]] const std::map<std::string, std::string>& comments() const { return comments_; }

  /// kUnreadable: "FILE:12: column 5 = 'abc': WHAT"; columns count from 1.
  [[nodiscard]] Error bad_field(const FieldLine& line,
                                std::size_t column,
                                const std::string& what) const;
  /// kUnreadable: "FILE:12: WHAT".
  [[nodiscard]] Error bad_line(const FieldLine& line, const std::string& what) const;

  /// Errors: kUnreadable if the line does not have exactly `count` fields.
  [[nodiscard]] Status expect_fields(const FieldLine& line, std::size_t count) const;
  /// A finite decimal number. Errors: kUnreadable.
  [[nodiscard]] Result<double> number(const FieldLine& line, std::size_t column) const;
  /// Seconds as a decimal, exact to the nanosecond for any size (a double holding today's seconds
  /// since 1970 resolves only 240 ns). Errors: kUnreadable.
  [[nodiscard]] Result<std::int64_t> time_s(const FieldLine& line, std::size_t column) const;
  /// The same in any unit.
  [[nodiscard]] Result<std::int64_t> time(const FieldLine& line,
                                          std::size_t column,
                                          TimeUnit unit) const;
  /// Whole nanoseconds. Errors: kUnreadable.
  [[nodiscard]] Result<std::int64_t> time_ns(const FieldLine& line, std::size_t column) const;

 private:
  static Result<FieldFile> from_text(const std::filesystem::path& file,
                                     std::string text,
                                     const std::atomic<bool>* cancel,
                                     const Limits& limits);

  std::filesystem::path file_;
  std::shared_ptr<const std::string> text_;  // the fields point into it
  std::vector<FieldLine> lines_;
  std::map<std::string, std::string> comments_;
};

}  // namespace overfly
