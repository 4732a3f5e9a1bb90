// The samples of a run's sensors as curves for viewers, in bounded memory with their extremes.
#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/measure/bounded_series.hpp"
#include "core/result.hpp"
#include "core/sensors/sensor_samples.hpp"
#include "server/record/rows/sensor_index.hpp"

namespace overfly::server {

/// One value of a sensor over the time of the run.
struct SensorCurve {
  std::string name;                 ///< with its unit: a column of the sensor's file
  std::vector<SeriesPoint> points;  ///< by time; the value is the first one
};

struct SensorCurves {
  std::string sensor;         ///< name of its file, without the extension
  std::uint64_t samples = 0;  ///< in the stretch of time asked for
  std::vector<SensorCurve> curves;
};

struct SensorSeriesRequest {
  std::int64_t from_ns = 0;
  std::int64_t to_ns = std::numeric_limits<std::int64_t>::max();
  std::size_t max_intervals = 500;  ///< of time: each keeps the extremes of every value
  /// Error of a fix (east, north, up) [m], if it is known: the curves east_error_m, north_error_m
  /// and up_error_m of the GPS. Without the function these curves are absent.
  std::function<std::optional<Eigen::Vector3d>(const GpsSample&)> gps_error;
};

struct SensorSeries {
  std::vector<SensorCurves> sensors;
  std::uint64_t bytes_read = 0;  ///< of the files
};

/// Reads the sensor files of a run folder, also while the run appends to them. Sensors without a
/// file are left out. A value that is not finite (no fix, no echo) is no point of its curve.
/// Memory: independent of the size of the files.
/// @param index  of that run: rows that it knows are read only in the stretch of time asked for.
/// It is extended by the others, which are read all
/// Errors: as SensorFilesReader; kCancelled.
[[nodiscard]] Result<SensorSeries> read_sensor_series(const std::filesystem::path& run_folder,
                                                      const SensorSeriesRequest& request,
                                                      SensorIndex& index,
                                                      const std::atomic<bool>* cancel = nullptr);

}  // namespace overfly::server
