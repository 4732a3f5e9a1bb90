// Intersects a line of sight with the ground.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/earth/height_query.hpp"

namespace overfly::renderer {

/// Casts a ray to the ground by marching and bisection. Ridges thinner than a third of the ray's
/// clearance may be missed.
/// @param direction_world  unit vector
/// @param max_range_m  search limit
/// @return the first point below the ground, within 0.01 m; empty if there is none
[[nodiscard]] std::optional<Eigen::Vector3d> cast_to_ground(const HeightQuery& ground,
                                                            const Eigen::Vector3d& origin_world,
                                                            const Eigen::Vector3d& direction_world,
                                                            double max_range_m);

/// Refines the depth of a ray's intersection with a model of the ground (a mesh, cells of rays) on
/// the ground itself, by secant steps to 1 mm of clearance.
/// @param direction_world  its length corresponds to a depth of 1
/// @return depth_m unchanged if the ground is farther from it than 2 % and 1 m: there is a fold in
/// between, where the model is more accurate
[[nodiscard]] double refine_depth(const HeightQuery& ground,
                                  const Eigen::Vector3d& origin_world,
                                  const Eigen::Vector3d& direction_world,
                                  double depth_m);

}  // namespace overfly::renderer
