#include "server/record/rows/sensor_series.hpp"

#include <cmath>
#include <tuple>
#include <utility>

#include "core/cancel.hpp"
#include "server/record/rows/sensor_files.hpp"
#include "server/record/rows/sensor_rows.hpp"

namespace overfly::server {
namespace {

/// Samples of each sensor that are in memory at a time.
constexpr std::size_t kChunk = 4096;
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

  void add(const SensorSamples& samples) {
    for (const Sample& sample : samples.*Row::kSamples) {
      present_ = true;
      if (sample.t_ns < request_.from_ns || sample.t_ns > request_.to_ns) continue;
      ++count_;
      const auto values = Row::values(sample);
      for (std::size_t i = 0; i < values.size(); ++i) {
        add_finite(columns_[i], sample.t_ns, values[i]);
      }
      add_error(sample);
    }
  }

  void finish(std::vector<SensorCurves>& sensors) const {
    if (!present_) return;
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
  bool present_ = false;
};

}  // namespace

Result<std::vector<SensorCurves>> read_sensor_series(const std::filesystem::path& run_folder,
                                                     const SensorSeriesRequest& request,
                                                     const std::atomic<bool>* cancel) {
  Result<SensorFilesReader> reader = SensorFilesReader::open(run_folder);
  if (!reader) return reader.error();
  std::tuple collectors{CurveCollector<ImuSample>(request),
                        CurveCollector<GpsSample>(request),
                        CurveCollector<BarometerSample>(request),
                        CurveCollector<AirspeedSample>(request),
                        CurveCollector<MagnetometerSample>(request),
                        CurveCollector<RangeSample>(request)};
  while (true) {
    if (is_cancelled(cancel)) return Error{ErrorCode::kCancelled, "cancelled"};
    const Result<SensorSamples> samples = reader->next(kChunk);
    if (!samples) return samples.error();
    if (samples->empty()) break;
    std::apply([&](auto&... collector) { (collector.add(*samples), ...); }, collectors);
  }
  std::vector<SensorCurves> sensors;
  std::apply([&](const auto&... collector) { (collector.finish(sensors), ...); }, collectors);
  return sensors;
}

}  // namespace overfly::server
