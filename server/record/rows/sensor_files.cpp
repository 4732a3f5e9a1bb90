#include "server/record/rows/sensor_files.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/outside/forward_reader.hpp"
#include "core/text/number_text.hpp"
#include "server/files/file_field.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/rows/sensor_rows.hpp"

namespace overfly::server {

namespace fs = std::filesystem;

namespace sensor_rows {

template <template <typename> typename Part>
using OfEachSensor = std::tuple<Part<ImuSample>,
                                Part<BarometerSample>,
                                Part<GpsSample>,
                                Part<AirspeedSample>,
                                Part<MagnetometerSample>,
                                Part<RangeSample>>;

/// Whole numbers without an exponent, for readers that take them as integers.
inline std::string row_value_text(double value) {
  constexpr double kExactBelow = 1e15;
  const bool whole = std::abs(value) < kExactBelow && value == std::trunc(value) && value != 0.0;
  return whole ? std::to_string(static_cast<std::int64_t>(value)) : number_text(value);
}

template <typename Sample>
class RowWriter {
 public:
  Status add(const fs::path& folder, const SensorSamples& samples) {
    using Row = SensorRow<Sample>;
    const std::vector<Sample>& added = samples.*Row::kSamples;
    if (added.empty()) return {};
    std::string text;
    if (!file_) {
      std::error_code failed;
      fs::create_directories(folder, failed);
      Result<AppendFile> created = AppendFile::create(folder / Row::kFile);
      if (!created) return created.error();
      file_.emplace(std::move(*created));
      text = Row::kHeader + std::string("\n");
    }
    for (const Sample& sample : added) {
      text += std::to_string(sample.t_ns);
      for (const double value : Row::values(sample)) text += ',' + row_value_text(value);
      text += '\n';
    }
    return file_->append(text);
  }

 private:
  std::optional<AppendFile> file_;
};

/// One file, line by line, and the sample that was read but is not due yet.
template <typename Sample>
class RowReader {
 public:
  using Row = SensorRow<Sample>;

  Status open(const fs::path& folder) {
    name_ = folder / Row::kFile;
    Result<ForwardReader> opened = ForwardReader::open(name_);
    if (!opened) {
      return opened.error().code == ErrorCode::kNotFound ? Status() : opened.error();
    }
    file_.emplace(std::move(*opened));
    const Result<std::optional<std::string_view>> header = line();
    if (!header) return header.error();
    if (*header && **header != Row::kHeader) {
      return bad_line("must be \"" + std::string(Row::kHeader) + "\"");
    }
    return {};
  }

  /// @param after_ns  samples that were available then are left out
  /// @param limit     of samples
  Status read_until(std::int64_t t_ns,
                    std::int64_t after_ns,
                    std::size_t limit,
                    SensorSamples& samples) {
    for (std::size_t read = 0; file_ && read < limit; ++read) {
      if (!next_) {
        if (Status status = read_next(); !status) return status;
        if (!next_) return {};
      }
      if (available_ns(*next_) > t_ns) return {};
      if (available_ns(*next_) > after_ns) (samples.*Row::kSamples).push_back(*next_);
      next_.reset();
    }
    return {};
  }

 private:
  static constexpr std::size_t kMaxLineBytes = 1024;

  /// The next complete line, without its end; empty at the end of the file.
  Result<std::optional<std::string_view>> line() {
    file_->skip(line_bytes_);
    line_bytes_ = 0;
    const auto bytes = file_->ahead(kMaxLineBytes);
    if (!bytes) return bytes.error();
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()),
                                std::min(bytes->size(), kMaxLineBytes));
    ++number_;
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

  Status read_next() {
    const auto text = line();
    if (!text) return text.error();
    if (!*text) {
      file_.reset();
      return {};
    }
    std::int64_t t_ns = 0;
    std::array<double, Row::kValues> values{};
    const char* at = (*text)->data();
    const char* const end = at + (*text)->size();
    auto parsed = std::from_chars(at, end, t_ns);
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
    if (available_ns(sample) < last_ns_) {
      return bad_line("must not be before the previous line's time");
    }
    last_ns_ = available_ns(sample);
    next_ = sample;
    return {};
  }

  [[nodiscard]] Error bad_line(const std::string& must) const {
    return {ErrorCode::kUnreadable, name_.string() + ":" + std::to_string(number_) + ": " + must};
  }

  fs::path name_;
  std::optional<ForwardReader> file_;  ///< empty: no file, or its end was reached
  std::size_t line_bytes_ = 0;         ///< of the last line
  std::int64_t number_ = 0;            ///< of the last line
  std::int64_t last_ns_ = 0;
  std::optional<Sample> next_;
};

}  // namespace sensor_rows

fs::path sensors_folder(const fs::path& run_folder) { return run_folder / "sensors"; }

struct SensorFilesWriter::Files {
  fs::path folder;
  sensor_rows::OfEachSensor<sensor_rows::RowWriter> writers;
};

SensorFilesWriter::SensorFilesWriter(const fs::path& run_folder)
    : files_(std::make_unique<Files>()) {
  files_->folder = sensors_folder(run_folder);
}
SensorFilesWriter::~SensorFilesWriter() = default;
SensorFilesWriter::SensorFilesWriter(SensorFilesWriter&& other) noexcept = default;
SensorFilesWriter& SensorFilesWriter::operator=(SensorFilesWriter&& other) noexcept = default;

Status SensorFilesWriter::add(const SensorSamples& samples) {
  Status status;
  std::apply(
      [&](auto&... writer) { (void)(... && (status = writer.add(files_->folder, samples)).ok()); },
      files_->writers);
  return status;
}

struct SensorFilesReader::Files {
  sensor_rows::OfEachSensor<sensor_rows::RowReader> readers;
};

SensorFilesReader::SensorFilesReader(std::unique_ptr<Files> files) : files_(std::move(files)) {}
SensorFilesReader::~SensorFilesReader() = default;
SensorFilesReader::SensorFilesReader(SensorFilesReader&& other) noexcept = default;
SensorFilesReader& SensorFilesReader::operator=(SensorFilesReader&& other) noexcept = default;

Result<SensorFilesReader> SensorFilesReader::open(const fs::path& run_folder) {
  auto files = std::make_unique<Files>();
  const fs::path folder = sensors_folder(run_folder);
  Status status;
  std::apply([&](auto&... reader) { (void)(... && (status = reader.open(folder)).ok()); },
             files->readers);
  if (!status) return status.error();
  return SensorFilesReader(std::move(files));
}

Result<SensorSamples> SensorFilesReader::read(std::int64_t t_ns,
                                              std::int64_t after_ns,
                                              std::size_t limit) {
  SensorSamples samples;
  Status status;
  std::apply(
      [&](auto&... reader) {
        (void)(... && (status = reader.read_until(t_ns, after_ns, limit, samples)).ok());
      },
      files_->readers);
  if (!status) return status.error();
  return samples;
}

Result<SensorSamples> SensorFilesReader::until(std::int64_t t_ns, std::int64_t after_ns) {
  return read(t_ns, after_ns, std::numeric_limits<std::size_t>::max());
}

Result<SensorSamples> SensorFilesReader::next(std::size_t limit) {
  constexpr auto kTimes = std::numeric_limits<std::int64_t>();
  return read(kTimes.max(), kTimes.min(), limit);
}

}  // namespace overfly::server
