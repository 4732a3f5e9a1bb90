// Inside terrain only: the map plane and the tile grid for a set of imagery files.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/earth/geodesy.hpp"
#include "terrain/imagery/imagery_raster.hpp"
#include "terrain/place/map_plane.hpp"
#include "terrain/place/smooth_map.hpp"

namespace overfly::terrain {

struct WorldLayout {
  MapPlane plane;
  TileGrid grid;
  MapRect extent;              ///< of all imagery on the map
  bool first_aligned = false;  ///< the first file's texels are the tiles' texels
  int pad_x = 0;               ///< grid texels left of the first file's, if it is aligned
  int pad_y = 0;
  double center_lat_rad = 0.0;  ///< of the extent
  double center_lon_rad = 0.0;
};

/// Chooses the map: the first file's own grid, scaled to metres, if it is projected, north-up and
/// has square texels (to 1 %); else a transverse Mercator at `origin` (or at the imagery's centre)
/// with the first file's finest texel size.
/// Errors: kInvalidArgument naming the file that cannot be transformed.
[[nodiscard]] Result<WorldLayout> lay_out_world(
    const std::vector<std::shared_ptr<const ImageryRaster>>& rasters,
    const std::optional<Geodetic>& origin);

}  // namespace overfly::terrain
