// Viewpoints that follow, circle or overlook the aircraft.
#pragma once

#include "core/earth/height_query.hpp"
#include "core/motion/pose.hpp"

namespace overfly::renderer {

/// Angles give the viewpoint's direction as seen from the target.
struct Viewpoint {
  double azimuth_rad = 0.0;
  double elevation_rad = 0.4;  ///< above the horizon, in [-pi/2, pi/2]
  double distance_m = 120.0;   ///< > 0
  double min_above_m = 2.0;    ///< the camera is raised to at least this above the ground
};

/// Follows from behind, independent of the bank.
/// @param view  azimuth 0 = straight behind the tail, positive to the left of the tail as seen from
///              above (clockwise)
/// @return T_world_camera, upright, looking at the aircraft
[[nodiscard]] Pose chase_viewpoint(const Pose& T_world_body,
                                   const Viewpoint& view,
                                   const HeightQuery& ground);

/// Looks at a target from a compass direction. @param view  azimuth clockwise from north
[[nodiscard]] Pose orbit_viewpoint(const Eigen::Vector3d& target_world,
                                   const Viewpoint& view,
                                   const HeightQuery& ground);

/// Looks straight down from distance_m above a target.
/// @param up_azimuth_rad  the compass direction at the image's top; 0 = north
[[nodiscard]] Pose top_viewpoint(const Eigen::Vector3d& target_world,
                                 double up_azimuth_rad,
                                 double distance_m);

/// Looks ahead from above the cockpit and moves with the aircraft.
/// @param azimuth_rad, elevation_rad  of the line of sight relative to the nose, to the right and
/// up
[[nodiscard]] Pose onboard_viewpoint(const Pose& T_world_body,
                                     double azimuth_rad,
                                     double elevation_rad);

/// Looks from anywhere, upright. @param azimuth_rad  of the line of sight, clockwise from north
/// @param elevation_rad  of the line of sight above the horizon, in [-pi/2, pi/2]
/// @param min_above_m  the camera is raised to at least this above the ground
[[nodiscard]] Pose free_viewpoint(const Eigen::Vector3d& eye_world,
                                  double azimuth_rad,
                                  double elevation_rad,
                                  double min_above_m,
                                  const HeightQuery& ground);

/// A camera at `eye` that looks at `target`, upright.
/// @param up_world  used where the line of sight is within 0.001 rad of the vertical
[[nodiscard]] Pose look_at(const Eigen::Vector3d& eye_world,
                           const Eigen::Vector3d& target_world,
                           const Eigen::Vector3d& up_world);

}  // namespace overfly::renderer
