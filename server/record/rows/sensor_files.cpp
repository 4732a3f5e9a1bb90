#include "server/record/rows/sensor_files.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "core/text/number_text.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/rows/sensor_row_reader.hpp"

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

/// One file, and the sample that was read but is not due yet.
template <typename Sample>
class RowReader {
 public:
  using Row = SensorRow<Sample>;

  Status open(const fs::path& folder) {
    const Result<bool> present = rows_.open(folder);
    if (!present) return present.error();
    if (!*present) return {};
    if (Status status = rows_.read_header(); !status) return status;
    rows_.go_to(rows_.place(), rows_.size_bytes());
    more_ = true;
    return {};
  }

  /// @param after_ns  samples that were available then are left out
  /// @param limit     of samples
  Status read_until(std::int64_t t_ns,
                    std::int64_t after_ns,
                    std::size_t limit,
                    SensorSamples& samples) {
    for (std::size_t read = 0; more_ && read < limit; ++read) {
      if (!next_) {
        const Result<std::optional<Sample>> next = rows_.next();
        if (!next) return next.error();
        next_ = *next;
        more_ = next_.has_value();
        if (!more_) return {};
      }
      if (available_ns(*next_) > t_ns) return {};
      if (available_ns(*next_) > after_ns) (samples.*Row::kSamples).push_back(*next_);
      next_.reset();
    }
    return {};
  }

 private:
  SensorRowReader<Sample> rows_;
  bool more_ = false;  ///< false: no file, or its end was reached
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
