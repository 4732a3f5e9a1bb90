// The ground at a latitude and longitude.
#pragma once

#include <Eigen/Core>

#include "terrain/tile_source.hpp"

namespace overfly::server {

struct GroundPlace {
  Eigen::Vector2d map_m{0.0, 0.0};         ///< on the tiles' map plane
  Eigen::Vector3d world_m{0.0, 0.0, 0.0};  ///< in the world frame
  double alt_ellipsoid_m = 0.0;
};

/// The ground's point on the ellipsoid's normal at a place. (HeightQuery uses vertical lines of the
/// world frame, which are inclined to it by the distance over the earth's radius.)
/// @param place  its height is the first guess of the ground's: a neighbour's is a good one
[[nodiscard]] GroundPlace ground_at(const terrain::TileSource& tiles, const Geodetic& place);

}  // namespace overfly::server
