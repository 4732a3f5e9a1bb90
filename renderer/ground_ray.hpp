// Where a line of sight meets the ground.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/height_query.hpp"

namespace overfly::renderer {

/// Casts a ray to the ground by marching and bisection. Ridges thinner than a third of the ray's
/// clearance may be passed through.
/// @param direction_world  unit vector
/// @param max_range_m      search limit
/// @return the first point below the ground within 0.01 m; empty if there is none
[[nodiscard]] std::optional<Eigen::Vector3d> cast_to_ground(const HeightQuery& ground,
                                                            const Eigen::Vector3d& origin_world,
                                                            const Eigen::Vector3d& direction_world,
                                                            double max_range_m);

}  // namespace overfly::renderer
