// The flight of a log as poses: positions joined with attitudes, and written to files.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/trajectory.hpp"
#include "core/result.hpp"
#include "flight/logs/flight_log.hpp"
#include "flight/logs/log_pose.hpp"
#include "flight/logs/truth/logged_truth.hpp"

namespace overfly::flight::logs {

struct LogTrajectory : LoggedTruth {
  std::vector<LogPose> poses;  ///< times strictly increasing
  /// As PoseJoiner::take_attitudes(), if the request is to keep them.
  std::vector<LogAttitude> attitudes;
};

/// Reads the positions of a log, and the attitudes interpolated (SLERP) at their times.
///
/// Of a clock that starts again within the log, the run with the most positions is used. Positions
/// with a time that is not later than the one before, and those without an attitude on both sides
/// within 1 s, are left out and counted.
/// Memory: 64 bytes a pose, and 32 bytes an attitude that is kept.
/// Errors: as read_truth_samples; kUnreadable if no pose is left.
[[nodiscard]] Result<LogTrajectory> read_log_trajectory(const OpenedLog& log,
                                                        const TrajectoryRequest& request,
                                                        const std::atomic<bool>* cancel = nullptr);

/// T_world_body: world = east-north-up at the first pose, body = forward-right-down, time = the
/// vehicle's clock. Heights above mean sea level stand for those above the ellipsoid: at 100 m of
/// separation the positions change by 16 mm in 1 km.
[[nodiscard]] Trajectory world_trajectory(const LogTrajectory& trajectory);

/// Writes world_trajectory() as a TUM file. Comments give the origin and the sources. Errors: kIo.
[[nodiscard]] Status write_log_tum(const std::filesystem::path& file,
                                   const LogTrajectory& trajectory);

/// Writes a CSV file with the columns t_s, lat_deg, lon_deg, alt_msl_m, roll_deg, pitch_deg,
/// yaw_deg. The column alt_ellipsoid_m, as scenarios fly it, replaces alt_msl_m if the heights are
/// those, or if the separation is given.
/// @param geoid_separation_m  height of the geoid above the ellipsoid at the place, which is added
/// to heights above mean sea level
/// Errors: kInvalidArgument if the positions are not georeferenced, or if a separation is given for
/// heights above the ellipsoid; kIo.
[[nodiscard]] Status write_log_csv(const std::filesystem::path& file,
                                   const LogTrajectory& trajectory,
                                   std::optional<double> geoid_separation_m = std::nullopt);

}  // namespace overfly::flight::logs
