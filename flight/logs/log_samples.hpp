// The positions and attitudes of a log's flight, each at their own times.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "flight/logs/log_pose.hpp"
#include "flight/logs/truth/logged_truth.hpp"

namespace overfly::flight::logs {

struct LogPosition {
  std::int64_t t_ns = 0;
  /// Latitude, longitude [deg] and height above the samples' datum [m], or north, east, down [m]
  /// from an unknown origin.
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
};

struct LogSamples : LoggedTruth {
  std::vector<LogPosition> positions;  ///< not empty, times strictly increasing
  std::vector<LogAttitude> attitudes;  ///< times strictly increasing
};

/// Reads the positions in the time asked for, and the attitudes in it and its margins.
///
/// Of a clock that starts again within the log, the run with the most positions is used. Positions
/// with a time that is not later than the one before, and attitudes with a time that another one
/// has, are left out and counted.
/// Errors: as read_truth_samples.
[[nodiscard]] Result<LogSamples> read_log_samples(const OpenedLog& log,
                                                  const TrajectoryRequest& request,
                                                  const std::atomic<bool>* cancel = nullptr);

}  // namespace overfly::flight::logs
