#include "server/record/rows/sensor_series.hpp"

#include <cmath>
#include <tuple>
#include <utility>

#include "core/cancel.hpp"
#include "server/record/rows/sensor_files.hpp"
#include "server/record/rows/sensor_row_reader.hpp"
#include "server/record/rows/sensor_rows.hpp"

namespace overfly::server {
namespace {

/// Rows between two looks at `cancel`.
constexpr std::size_t kRowsBetweenLooks = 4096;
constexpr std::array<const char*, 3> kErrorNames = {"east_error_m", "north_error_m", "up_error_m"};

/// The columns of a header line "t_ns,a,b" without the time.
std::vector<std::string> value_columns(const std::string& header) {
  std::vector<std::string> names;
  for (std::size_t comma = header.find(','); comma != std::string::npos;) {
    const std::size_t next = header.find(',', comma + 1);
    names.push_back(header.substr(comma + 1, next - comma - 1));
    comma = next;
  }
  return names;
}

void add_finite(BoundedSeries& series, std::int64_t t_ns, double value) {
  if (std::isfinite(value)) series.add({t_ns, {value}});
}

template <typename Sample>
class CurveCollector {
 public:
  using Row = SensorRow<Sample>;

  explicit CurveCollector(const SensorSeriesRequest& request)
      : request_(request), columns_(Row::kValues, BoundedSeries(1, request.max_intervals)) {
    if (has_errors()) errors_.assign(kErrorNames.size(), BoundedSeries(1, request.max_intervals));
  }

  void add(const Sample& sample) {
    if (sample.t_ns < request_.from_ns || sample.t_ns > request_.to_ns) return;
    ++count_;
    const auto values = Row::values(sample);
    for (std::size_t i = 0; i < values.size(); ++i) {
      add_finite(columns_[i], sample.t_ns, values[i]);
    }
    add_error(sample);
  }

  void finish(std::vector<SensorCurves>& sensors) const {
    const std::string file = Row::kFile;
    SensorCurves curves{file.substr(0, file.rfind('.')), count_, {}};
    const std::vector<std::string> names = value_columns(Row::kHeader);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      curves.curves.push_back({names[i], columns_[i].points()});
    }
    for (std::size_t i = 0; i < errors_.size(); ++i) {
      curves.curves.push_back({kErrorNames[i], errors_[i].points()});
    }
    sensors.push_back(std::move(curves));
  }

 private:
  [[nodiscard]] bool has_errors() const {
    return std::is_same_v<Sample, GpsSample> && request_.gps_error != nullptr;
  }
  void add_error(const Sample& sample) {
    if constexpr (std::is_same_v<Sample, GpsSample>) {
      if (errors_.empty()) return;
      const std::optional<Eigen::Vector3d> error = request_.gps_error(sample);
      if (!error) return;
      for (Eigen::Index i = 0; i < 3; ++i) {
        add_finite(errors_[static_cast<std::size_t>(i)], sample.t_ns, (*error)[i]);
      }
    }
  }

  const SensorSeriesRequest& request_;
  std::vector<BoundedSeries> columns_;
  std::vector<BoundedSeries> errors_;
  std::uint64_t count_ = 0;
};

/// Reads one sensor's file. The parts that the index knows must be as it says.
template <typename Sample>
class FileSeries {
 public:
  FileSeries(const std::filesystem::path& run_folder,
             const SensorSeriesRequest& request,
             const std::atomic<bool>* cancel)
      : folder_(sensors_folder(run_folder)), request_(request), cancel_(cancel) {}

  /// @param file  its number in the index
  Status read(SensorIndex& index, std::size_t file, SensorSeries& series) {
    const FileStamp stamp = FileStamp::of(folder_ / SensorRow<Sample>::kFile);
    SensorFileIndex known = index.of(file, stamp);
    Status status = read_with(known, series);
    // Rows that are not where they were: the file is another one in spite of its stamp.
    if (!status && status.error().code == ErrorCode::kUnreadable && is_old_part_) {
      known = SensorFileIndex();
      status = read_with(known, series);
    }
    if (!status) return status;
    if (!known.started()) return {};
    known.stamp = stamp;
    index.keep(file, std::move(known));
    return {};
  }

 private:
  Status read_with(SensorFileIndex& known, SensorSeries& series) {
    SensorRowReader<Sample> rows;
    const Result<bool> present = rows.open(folder_);
    if (!present) return present.error();
    if (!*present) return {};
    CurveCollector<Sample> collector(request_);
    Status status;
    if (!known.started()) {
      status = rows.read_header();
      known.start(rows.place());
    }
    is_old_part_ = true;
    for (const SensorBlock& stretch : known.stretches(request_.from_ns, request_.to_ns)) {
      if (!status) break;
      rows.go_to(stretch.begin, stretch.end);
      status = take(rows, [&](const Sample& sample) { collector.add(sample); });
    }
    if (status) {
      is_old_part_ = false;
      rows.go_to(known.end(), rows.size_bytes());
      status = take(rows, [&](const Sample& sample) {
        known.add(sample.t_ns, rows.place());
        collector.add(sample);
      });
    }
    series.bytes_read += rows.bytes_read();
    if (!status) return status;
    if (!known.empty()) collector.finish(series.sensors);
    return {};
  }

  template <typename Take>
  Status take(SensorRowReader<Sample>& rows, const Take& each) {
    for (std::size_t i = 0;; ++i) {
      if (i % kRowsBetweenLooks == 0 && is_cancelled(cancel_)) {
        return Error{ErrorCode::kCancelled, "cancelled"};
      }
      const Result<std::optional<Sample>> sample = rows.next();
      if (!sample) return sample.error();
      if (!*sample) return {};
      each(**sample);
    }
  }

  std::filesystem::path folder_;
  const SensorSeriesRequest& request_;
  const std::atomic<bool>* cancel_;
  bool is_old_part_ = false;  ///< rows that the index knows are being read
};

}  // namespace

Result<SensorSeries> read_sensor_series(const std::filesystem::path& run_folder,
                                        const SensorSeriesRequest& request,
                                        SensorIndex& index,
                                        const std::atomic<bool>* cancel) {
  std::tuple files{FileSeries<ImuSample>(run_folder, request, cancel),
                   FileSeries<GpsSample>(run_folder, request, cancel),
                   FileSeries<BarometerSample>(run_folder, request, cancel),
                   FileSeries<AirspeedSample>(run_folder, request, cancel),
                   FileSeries<MagnetometerSample>(run_folder, request, cancel),
                   FileSeries<RangeSample>(run_folder, request, cancel)};
  static_assert(std::tuple_size_v<decltype(files)> == SensorIndex::kFiles);
  SensorSeries series;
  Status status;
  std::size_t number = 0;
  std::apply(
      [&](auto&... file) { (void)(... && (status = file.read(index, number++, series)).ok()); },
      files);
  if (!status) return status.error();
  return series;
}

}  // namespace overfly::server
