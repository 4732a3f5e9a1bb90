// The flight of a log as poses: positions joined with attitudes, and written to files.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "flight/logs/flight_log.hpp"
#include "flight/logs/log_samples.hpp"

namespace overfly::flight::logs {

/// A pose of the aircraft by the vehicle's clock.
struct LogPose {
  std::int64_t t_ns = 0;
  /// Latitude, longitude [deg] and height above mean sea level [m], or north, east, down [m] from
  /// an unknown origin.
  Eigen::Vector3d position;
  Eigen::Quaterniond R_ned_body;  ///< body forward-right-down relative to north-east-down
};

struct LogTrajectory {
  std::vector<LogPose> poses;  ///< times strictly increasing
  bool georeferenced = false;
  std::string position_source;
  std::string attitude_source;
  /// What was left out, with counts.
  std::vector<std::string> warnings;
};

/// Reads the positions of a log, and the attitudes interpolated (SLERP) at their times.
///
/// Positions without an attitude on both sides within 1 s are left out and counted.
/// Memory: about 160 bytes a pose.
/// Errors: as read_log_samples; kUnreadable if no pose is left.
[[nodiscard]] Result<LogTrajectory> read_log_trajectory(const OpenedLog& log,
                                                        const TrajectoryRequest& request,
                                                        const std::atomic<bool>* cancel = nullptr);

/// Writes T_world_body as a TUM file: world = east-north-up at the first pose, body =
/// forward-right-down, time = the vehicle's clock. Comments give the origin and the sources.
/// Heights above mean sea level stand for those above the ellipsoid: at 100 m of separation the
/// positions change by 16 mm in 1 km. Errors: kIo.
[[nodiscard]] Status write_log_tum(const std::filesystem::path& file,
                                   const LogTrajectory& trajectory);

/// Writes a CSV file with the columns t_s, lat_deg, lon_deg, alt_msl_m, roll_deg, pitch_deg,
/// yaw_deg.
/// @param geoid_separation_m  height of the geoid above the ellipsoid at the place: if given, the
/// column alt_ellipsoid_m = alt_msl_m + geoid_separation_m replaces alt_msl_m, as scenarios fly it
/// Errors: kInvalidArgument if the positions are not georeferenced; kIo.
[[nodiscard]] Status write_log_csv(const std::filesystem::path& file,
                                   const LogTrajectory& trajectory,
                                   std::optional<double> geoid_separation_m = std::nullopt);

}  // namespace overfly::flight::logs
