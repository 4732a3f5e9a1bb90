// What a viewer sees of a flight log: its track, heights, speeds and attitudes in bounded memory.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/measure/bounded_series.hpp"
#include "core/result.hpp"
#include "flight/logs/flight_log.hpp"

namespace overfly::flight::logs {

struct LogSeriesRequest {
  std::string source;                ///< as choose_truth()
  std::size_t max_intervals = 1000;  ///< of time: each keeps the extremes of every value
};

/// A step of the positions of more than 20 m and 150 m/s.
struct LogStep {
  std::int64_t t_ns = 0;
  double size_m = 0.0;
};

struct LogSeries {
  std::string position_source;
  std::string attitude_source;  ///< empty if the vehicle has no attitudes
  std::string vehicle;          ///< of the positions, as in StreamDescription
  std::uint32_t run = 0;        ///< of that vehicle's clock: LogTime::boot
  bool georeferenced = false;
  HeightDatum height = HeightDatum::kMeanSeaLevel;  ///< of georeferenced positions
  /// Latitude, longitude [deg], height above the datum [m]; or north, east, up [m] from an unknown
  /// origin.
  std::vector<SeriesPoint> positions;
  std::vector<SeriesPoint> speeds;     ///< over ground [m/s], mean over at least 0.2 s
  std::vector<SeriesPoint> attitudes;  ///< roll, pitch, yaw relative to north-east-down [rad]
  std::uint64_t position_count = 0;    ///< in the log's slice
  std::uint64_t attitude_count = 0;
  std::vector<LogStep> steps;  ///< the first kMaxLogSteps
};

inline constexpr std::size_t kMaxLogSteps = 200;

/// Reads a log's slice once more. Of a clock that starts again, the run with the most positions is
/// taken.
/// Memory: independent of the size of the log.
/// Errors: as choose_truth and read_log_into; kUnreadable if there are no valid positions.
[[nodiscard]] Result<LogSeries> read_log_series(const OpenedLog& log,
                                                const LogSeriesRequest& request,
                                                const std::atomic<bool>* cancel = nullptr);

}  // namespace overfly::flight::logs
