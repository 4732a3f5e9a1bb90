// Reads the rows of one sensor's file. Private to server/record.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/outside/forward_reader.hpp"
#include "core/result.hpp"
#include "server/files/file_field.hpp"
#include "server/record/rows/sensor_rows.hpp"

namespace overfly::server {

/// A place between two rows of a file.
struct RowPlace {
  std::uint64_t offset = 0;  ///< of the next row
  std::int64_t lines = 0;    ///< in front of it, with the header
  std::int64_t last_ns = 0;  ///< when the sample in front of it was available
};

/// A last line without line feed, as left by a killed program or while it is written, is not read.
template <typename Sample>
class SensorRowReader {
 public:
  using Row = SensorRow<Sample>;

  /// Reads nothing yet. @return false if there is no file
  /// Errors: as ForwardReader::open.
  Result<bool> open(const std::filesystem::path& folder) {
    name_ = folder / Row::kFile;
    Result<ForwardReader> opened = ForwardReader::open(name_);
    if (!opened) {
      if (opened.error().code == ErrorCode::kNotFound) return false;
      return opened.error();
    }
    size_bytes_ = opened->size_bytes();
    file_.emplace(std::move(*opened));
    return true;
  }

  /// @pre opened. Errors: kUnreadable for another first line; kIo.
  Status read_header() {
    go_to({}, kMaxLineBytes);
    const Result<std::optional<std::string_view>> header = line();
    if (!header) return header.error();
    if (*header && **header != Row::kHeader) {
      return bad_line("must be \"" + std::string(Row::kHeader) + "\"");
    }
    if (*header) step();
    return {};
  }

  /// Continues there, up to an offset of the file. @pre opened
  void go_to(const RowPlace& place, std::uint64_t end) {
    place_ = place;
    end = std::min(end, size_bytes_);
    bytes_read_ += end - std::min(end, place.offset);
    file_->only({{place.offset, std::max(place.offset, end)}});
    line_bytes_ = 0;
  }

  /// The next sample; empty at the end.
  /// Errors: kIo; kUnreadable naming file, line and reason, also for a time before that of the
  /// previous line.
  Result<std::optional<Sample>> next() {
    const Result<std::optional<std::string_view>> text = line();
    if (!text) return text.error();
    if (!*text) return std::optional<Sample>();
    const Result<Sample> sample = sample_in(**text);
    if (!sample) return sample.error();
    place_.last_ns = available_ns(*sample);
    step();
    return std::optional(*sample);
  }

  /// Behind the last row that was taken.
  [[nodiscard]] const RowPlace& place() const { return place_; }
  [[nodiscard]] std::uint64_t size_bytes() const { return size_bytes_; }
  /// Of all stretches so far.
  [[nodiscard]] std::uint64_t bytes_read() const { return bytes_read_; }

 private:
  static constexpr std::size_t kMaxLineBytes = 1024;

  /// The next complete line, without its end; empty at the end of the stretch.
  Result<std::optional<std::string_view>> line() {
    file_->skip(std::exchange(line_bytes_, 0));
    const auto bytes = file_->ahead(kMaxLineBytes);
    if (!bytes) return bytes.error();
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()),
                                std::min(bytes->size(), kMaxLineBytes));
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) {
      if (text.size() == kMaxLineBytes) {
        return bad_line("must have less than " + std::to_string(kMaxLineBytes) + " characters");
      }
      return std::optional<std::string_view>();
    }
    line_bytes_ = end + 1;
    return std::optional(text.substr(0, end));
  }

  void step() {
    place_.offset += line_bytes_;
    ++place_.lines;
  }

  Result<Sample> sample_in(std::string_view text) const {
    std::int64_t t_ns = 0;
    std::array<double, Row::kValues> values{};
    const char* const end = text.data() + text.size();
    auto parsed = std::from_chars(text.data(), end, t_ns);
    bool good = parsed.ec == std::errc() && t_ns >= 0 && t_ns <= kLargestFileInteger;
    for (double& value : values) {
      good = good && parsed.ptr != end && *parsed.ptr == ',';
      if (!good) break;
      parsed = std::from_chars(parsed.ptr + 1, end, value);
      good = parsed.ec == std::errc();
    }
    if (!good || parsed.ptr != end) {
      return bad_line("must be a time in [0, " + std::to_string(kLargestFileInteger) + "] ns and " +
                      std::to_string(Row::kValues) + " numbers, separated by commas");
    }
    const Sample sample = Row::sample(t_ns, values);
    if (available_ns(sample) < place_.last_ns) {
      return bad_line("must not be before the previous line's time");
    }
    return sample;
  }

  /// Of the line behind place().
  [[nodiscard]] Error bad_line(const std::string& must) const {
    return {ErrorCode::kUnreadable,
            name_.string() + ":" + std::to_string(place_.lines + 1) + ": " + must};
  }

  std::filesystem::path name_;
  std::optional<ForwardReader> file_;
  std::uint64_t size_bytes_ = 0;  ///< when the file was opened
  std::uint64_t bytes_read_ = 0;
  std::size_t line_bytes_ = 0;  ///< of the last line
  RowPlace place_;
};

}  // namespace overfly::server
