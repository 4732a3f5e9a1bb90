// Flights: the parametric course and logged trajectories.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/geodesy.hpp"
#include "core/height_query.hpp"
#include "core/truth_source.hpp"

namespace overfly::flight {

/// The paper's course: southbound straight and level from the north end of the runway, a turn,
/// and an oscillating return northbound.
struct CourseParameters {
  double airspeed_m_s = 25.0;            ///< [5, 80]
  double roll_rate_max_rad_s = 0.7853981633974483;  ///< (0, 3.5]; each reversal reaches it
  double height_agl_m = 300.0;           ///< [20, 3000] above the ground
  double bank_max_rad = 0.7853981633974483;         ///< (0, 1.2]
  double length_m = 3300.0;              ///< [500, 100000], all legs together
  double leg_length_m = 1100.0;          ///< straight initialisation leg, < length_m
  double start_east_m = 0.0;             ///< world
  double start_north_m = 0.0;
  double heading_rad = 3.141592653589793;  ///< of the initialisation leg, clockwise from north
};

/// Errors: kInvalidArgument naming field, value and limit.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> fly_course(
    const CourseParameters& parameters, std::shared_ptr<const HeightQuery> ground);

/// A pose file flown as it is: TUM (T_world_body in the world frame; with `camera_poses` set,
/// T_world_camera of a nadir camera) or CSV with the header
/// `t_s,lat_deg,lon_deg,alt_ellipsoid_m,roll_deg,pitch_deg,yaw_deg`.
/// Positions by cubic Hermite, rotations by SLERP; the clock starts at the first pose.
/// Errors: kNotFound; kUnreadable naming file, line, column and value.
[[nodiscard]] Result<std::unique_ptr<TruthSource>> fly_log(const std::filesystem::path& file,
                                                           const LocalFrame& frame,
                                                           bool camera_poses = false);

}  // namespace overfly::flight
