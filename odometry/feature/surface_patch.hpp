// Aligns patches around points of unknown surface: walls, roads and trees instead of one ground
// plane.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/camera/camera.hpp"
#include "core/motion/pose.hpp"
#include "odometry/image/patch_aligner.hpp"
#include "odometry/image/pyramid.hpp"

namespace overfly::odometry::feature {

/// A pixel of a source view with an assumed 3D point.
struct SurfacePoint {
  const Pyramid* source = nullptr;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector3d p_source = Eigen::Vector3d::UnitZ();  ///< in the source's camera
  int patch_level = 0;
};

struct SurfaceMatch {
  PatchMatch match;
  Eigen::Vector3d normal_source = Eigen::Vector3d::UnitZ();  ///< in the source's camera
};

/// Aligns the point's patch in another view, using planes that face the source camera or lie along
/// its axes (a road, walls on either side), and returns the plane with the best agreement.
///
/// @param coarser  number of levels above the patch's own at which the search starts
/// @return empty if no plane agrees
[[nodiscard]] std::optional<SurfaceMatch> align_on_surface(const PinholeCamera& camera,
                                                           const SurfacePoint& point,
                                                           const Pose& T_view_source,
                                                           const Pyramid& view,
                                                           int coarser);

}  // namespace overfly::odometry::feature
