// The web Mercator projection (EPSG:3857) in units of its square: x from 0 at 180 deg west to 1 at
// 180 deg east, y from 0 at 85.05 deg north to 1 at 85.05 deg south. Tile (zoom, x, y) of a web map
// is the cell (x, y) of its 2^zoom cells a side.
#pragma once

#include <Eigen/Core>

#include "core/earth/geodesy.hpp"

namespace overfly::server {

inline constexpr int kMapTilePx = 256;
inline constexpr int kMaxMapZoom = 24;

struct MapTileId {
  int zoom = 0;
  int x = 0;
  int y = 0;
};

/// IOGP Publication 373-7-2, method 1024 (Popular Visualisation Pseudo Mercator).
[[nodiscard]] Eigen::Vector2d mercator_from_geodetic(double lat_rad, double lon_rad);
/// On the ellipsoid. x may be outside [0, 1]: longitudes then continue.
[[nodiscard]] Geodetic geodetic_from_mercator(const Eigen::Vector2d& place);

/// Ground distance of a pixel at a latitude [m].
[[nodiscard]] double map_pixel_m(double lat_rad, int zoom);

}  // namespace overfly::server
