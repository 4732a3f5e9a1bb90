// Sources of true flights: the parametric course and logged trajectories.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>

#include "core/earth/geodesy.hpp"
#include "core/earth/height_query.hpp"
#include "core/motion/pose.hpp"
#include "core/motion/truth_source.hpp"

namespace overfly::flight {

/// The paper's course: from the north end of the runway straight and level to the south, a turn,
/// and an oscillating return to the north.
struct CourseParameters {
  double airspeed_m_s = 25.0;                       ///< [5, 80]
  double roll_rate_max_rad_s = 0.7853981633974483;  ///< (0, 3.5]; reached in each reversal
  double height_agl_m = 300.0;                      ///< [20, 3000] above the ground
  double bank_max_rad = 0.7853981633974483;         ///< (0, 1.2]
  double length_m = 3300.0;                         ///< [500, 100000], all legs together
  double leg_length_m = 1100.0;                     ///< of the straight first leg, < length_m
  double start_east_m = 0.0;                        ///< world
  double start_north_m = 0.0;
  double heading_rad = 3.141592653589793;  ///< of the first leg, clockwise from north
};

/// Minimum turn radius [m]. Slow flight banks less to respect it.
inline constexpr double kTurnRadiusMinM = 25.0;
/// Steepest climb while the course follows the ground [rad].
inline constexpr double kClimbMaxRad = 8.0 * kPi / 180.0;
/// Knot spacing of the course's height profile, in distance and in time.
inline constexpr double kHeightKnotM = 40.0;
inline constexpr double kHeightKnotS = 1.6;

/// Flies the course without wind in the tangent plane of the world frame.
///
/// The horizontal speed is constant. Turns are coordinated: turn rate = g tan(bank) / V, neglecting
/// the acceleration of the climb (a few percent of g). Roll rates rise and fall as raised cosines,
/// and each reversal reaches the limit. The nose points along the velocity: no angle of attack,
/// pitch = path angle. The height follows the smoothed ground. Up to 25 m/s it follows hills longer
/// than 800 m to within 4 % of their height and keeps less than 6 % of bumps below 80 m. The climb
/// angle is at most kClimbMaxRad.
///
/// Errors: kInvalidArgument naming field, value and limit (angles in degrees), for ground too steep
/// to follow, and if the clearance would fall below a quarter of height_agl_m.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> fly_course(
    const CourseParameters& parameters, std::shared_ptr<const HeightQuery> ground);

/// Flies the poses of a file: TUM (T_world_body in the world frame; with `camera_poses` set,
/// T_world_camera of a nadir camera) or CSV with the header
/// `t_s,lat_deg,lon_deg,alt_ellipsoid_m,roll_deg,pitch_deg,yaw_deg`.
/// Positions are interpolated by cubic Hermite splines, rotations by SLERP. Time 0 is the first
/// pose. The flight's `warnings` report rows that repeat a time or are out of order.
/// @param cancel  stops reading; may be null
/// Errors: as FieldFile::read; kUnreadable naming file, line, column and value.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> fly_log(
    const std::filesystem::path& file,
    const LocalFrame& frame,
    bool camera_poses = false,
    const std::atomic<bool>* cancel = nullptr);

}  // namespace overfly::flight
