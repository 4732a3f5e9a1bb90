// The distance to which a camera sees the ground.
#pragma once

#include <algorithm>
#include <cmath>

namespace overfly::renderer {

inline constexpr double kEarthRadiusM = 6371000.0;
inline constexpr double kMaxReachM = 300e3;  ///< map projections are distorted beyond

/// Distance to the farthest visible ground [m]: the camera's horizon plus that of the highest
/// ground, at most kMaxReachM.
/// @param above_m  height of the camera above the lowest ground, > 0
/// @param relief_m  height of the highest ground above the lowest, >= 0
[[nodiscard]] inline double horizon_m(double above_m, double relief_m) {
  return std::min(
      kMaxReachM,
      std::sqrt(2.0 * kEarthRadiusM * above_m) + std::sqrt(2.0 * kEarthRadiusM * relief_m));
}

}  // namespace overfly::renderer
