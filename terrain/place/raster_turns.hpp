// Inside terrain only: which turns of the earth a raster's columns are on.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "terrain/place/full_turn.hpp"
#include "terrain/place/map_plane.hpp"
#include "terrain/place/smooth_map.hpp"
#include "terrain/raster/georeference.hpp"

namespace overfly::terrain {

/// The turns on which a raster's columns meet an area of the map: one, or two if a raster around
/// the whole earth has its seam there. Empty values for a CRS without turns.
/// Errors: kInvalidArgument if PROJ knows no transformation; `what` names the file.
[[nodiscard]] Result<std::vector<std::optional<Turn>>> turns_over(const MapPlane& plane,
                                                                  const MapRect& area,
                                                                  const Georeference& place,
                                                                  int width_px,
                                                                  int height_px,
                                                                  const std::string& what);

}  // namespace overfly::terrain
