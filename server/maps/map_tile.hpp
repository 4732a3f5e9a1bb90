// Draws tiles of a web map from a world's imagery.
#pragma once

#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "server/maps/map_world.hpp"
#include "server/maps/mercator.hpp"

namespace overfly::server {

/// kMapTilePx pixels a side, RGB and opacity (4 channels), row 0 in the north; transparent where
/// the world has no imagery. Empty if the whole tile has none.
///
/// Pixels find their place on the world's map plane by nodes 16 pixels apart, between which it is
/// interpolated. Four samples a pixel are read from the level whose texels are at least half a
/// pixel and at most a pixel.
/// Errors: as terrain::TileSource::tile.
[[nodiscard]] Result<Image> draw_map_tile(const MapWorld& world,
                                          const MapTileId& id,
                                          const terrain::Cancelled& cancelled = {});

}  // namespace overfly::server
