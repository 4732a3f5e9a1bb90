// Finds the patch around a point of unknown surface: walls, roads and trees, not one ground.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/camera.hpp"
#include "core/pose.hpp"
#include "odometry/feature/patch_aligner.hpp"
#include "odometry/feature/pyramid.hpp"

namespace overfly::odometry {

/// A pixel of a source view, with a guess of what lies behind it.
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

/// Looks in a view where the point should be, over planes that face the source's camera or lie
/// along its axes (a road, walls on either side), and takes the one that agrees best.
///
/// @param coarser  levels above the patch's own at which the search begins
/// @return empty where none agrees
[[nodiscard]] std::optional<SurfaceMatch> align_on_surface(const PinholeCamera& camera,
                                                           const SurfacePoint& point,
                                                           const Pose& T_view_source,
                                                           const Pyramid& view,
                                                           int coarser);

}  // namespace overfly::odometry
