// Bundle adjustment of the part of the map around the newest keyframe.
#pragma once

#include "core/camera/camera.hpp"
#include "odometry/adjustment/bundle.hpp"
#include "odometry/feature/map/map.hpp"

namespace overfly::odometry::feature {

/// Adjusts the newest keyframe, the keyframes most covisible with it, and all points they observe.
/// Other keyframes that observe these points are fixed (Mur-Artal and Tardos 2017, section III-B,
/// eq. 3). Observations with a residual above `outlier` sigmas are then removed.
struct LocalAdjustment {
  int free_keyframes = 8;
  int fixed_keyframes = 12;  ///< maximum number of fixed keyframes
  double outlier = 6.0;
  BundleOptions solver;
};
void adjust_locally(const PinholeCamera& camera, const LocalAdjustment& options, Map& map);

}  // namespace overfly::odometry::feature
