// What a pixel of a camera looks at.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "renderer/renderer.hpp"

namespace overfly::server {

struct GroundSight {
  Eigen::Vector3d ground_world_m;
  double depth_m = 0.0;  ///< along the optical axis
  double range_m = 0.0;  ///< along the line of sight
};

/// Where a pixel's line of sight, at the middle of its row's exposure, meets the ground. Empty if
/// it meets none within 100 km, or if no direction maps to the pixel.
[[nodiscard]] std::optional<GroundSight> ground_sight(const renderer::CameraRequest& request,
                                                      const Eigen::Vector2d& pixel,
                                                      const HeightQuery& ground);

}  // namespace overfly::server
