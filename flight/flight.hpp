// Flights: the parametric course and logged trajectories.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>

#include "core/geodesy.hpp"
#include "core/height_query.hpp"
#include "core/pose.hpp"
#include "core/truth_source.hpp"

namespace overfly::flight {

/// The paper's course: southbound straight and level from the north end of the runway, a turn,
/// and an oscillating return northbound.
struct CourseParameters {
  double airspeed_m_s = 25.0;                       ///< [5, 80]
  double roll_rate_max_rad_s = 0.7853981633974483;  ///< (0, 3.5]; each reversal reaches it
  double height_agl_m = 300.0;                      ///< [20, 3000] above the ground
  double bank_max_rad = 0.7853981633974483;         ///< (0, 1.2]
  double length_m = 3300.0;                         ///< [500, 100000], all legs together
  double leg_length_m = 1100.0;                     ///< straight initialisation leg, < length_m
  double start_east_m = 0.0;                        ///< world
  double start_north_m = 0.0;
  double heading_rad = 3.141592653589793;  ///< of the initialisation leg, clockwise from north
};

/// No turn of the course is tighter [m]: slow flight banks less than its limit.
inline constexpr double kTurnRadiusMinM = 25.0;
/// Steepest climb while the course follows the ground [rad].
inline constexpr double kClimbMaxRad = 8.0 * kPi / 180.0;
/// Knots of the course's height over the ground are this far apart, in way and in time.
inline constexpr double kHeightKnotM = 40.0;
inline constexpr double kHeightKnotS = 1.6;

/// Flies the course, without wind, in the world frame's tangent plane.
///
/// Horizontally at constant speed; a turn is coordinated (turn rate = g tan(bank) / V, while the
/// climb's own acceleration, a few percent of g, is left out). Roll rates rise and fall as raised
/// cosines and each reversal reaches the limit. The nose lies along the velocity: no angle of
/// attack, pitch = path angle. The height follows the smoothed ground: up to 25 m/s it follows
/// hills longer than 800 m to within 4 % of their height, and of bumps below 80 m it takes less
/// than 6 %. It climbs at kClimbMaxRad at most.
///
/// Errors: kInvalidArgument naming field, value and limit (angles in degrees), for ground too steep
/// to follow, and where less than a quarter of height_agl_m would be left.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> fly_course(
    const CourseParameters& parameters, std::shared_ptr<const HeightQuery> ground);

/// A pose file flown as it is: TUM (T_world_body in the world frame; with `camera_poses` set,
/// T_world_camera of a nadir camera) or CSV with the header
/// `t_s,lat_deg,lon_deg,alt_ellipsoid_m,roll_deg,pitch_deg,yaw_deg`.
/// Positions by cubic Hermite, rotations by SLERP; the clock starts at the first pose. Rows that
/// repeat a time or stand out of order are in the flight's `warnings`.
/// @param cancel  ends reading early; may be null
/// Errors: as FieldFile::read; kUnreadable naming file, line, column and value.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> fly_log(
    const std::filesystem::path& file,
    const LocalFrame& frame,
    bool camera_poses = false,
    const std::atomic<bool>* cancel = nullptr);

}  // namespace overfly::flight
