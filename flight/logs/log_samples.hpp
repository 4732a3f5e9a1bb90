// The positions and attitudes of a log's flight, each at their own times.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "flight/logs/flight_log.hpp"

namespace overfly::flight::logs {

struct TrajectoryRequest {
  std::string source;  ///< as choose_truth()
  /// Limits by the vehicle's clock [ns], within the slice of the log; all of it without them.
  std::optional<std::int64_t> from_ns;
  std::optional<std::int64_t> to_ns;
  /// Added to the times of attitudes [ns].
  std::int64_t attitude_offset_ns = 0;
};

struct LogPosition {
  std::int64_t t_ns = 0;
  /// Latitude, longitude [deg] and height above the samples' datum [m], or north, east, down [m]
  /// from an unknown origin.
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
};

struct LogAttitude {
  std::int64_t t_ns = 0;
  Eigen::Quaternionf R_ned_body;  ///< body forward-right-down; not exactly of unit length
};

struct LogSamples {
  std::vector<LogPosition> positions;  ///< not empty, times strictly increasing
  std::vector<LogAttitude> attitudes;  ///< times strictly increasing
  bool georeferenced = false;
  HeightDatum height = HeightDatum::kMeanSeaLevel;  ///< of georeferenced positions
  std::string position_source;
  std::string attitude_source;
  /// What was left out, with counts.
  std::vector<std::string> warnings;
};

/// Reads the positions in the time asked for, and attitudes from 1 s before to 1 s after it.
///
/// Of a clock that starts again within the log, the run with the most positions is used. Positions
/// with a time that is not later than the one before, and attitudes with a time that another one
/// has, are left out and counted.
/// Errors: as open_log and choose_truth; kUnreadable if there are no positions in the time asked
/// for, or no attitudes of the same vehicle.
[[nodiscard]] Result<LogSamples> read_log_samples(const OpenedLog& log,
                                                  const TrajectoryRequest& request,
                                                  const std::atomic<bool>* cancel = nullptr);

/// What turns the heights of a source into heights above the ellipsoid [m]: the geoid's height, or
/// 0 for those that are. Errors: kInvalidArgument if a height of the geoid is given for heights
/// above the ellipsoid.
[[nodiscard]] Result<double> separation_of(HeightDatum height,
                                           const std::string& source,
                                           double geoid_separation_m);

}  // namespace overfly::flight::logs
