// The ground that the camera saw during a flight.
#pragma once

#include <vector>

#include "renderer/renderer.hpp"
#include "server/timeline/run_timeline.hpp"

namespace overfly::server {

/// Tiles with imagery around the points where the main camera's axis meets the ground, by samples
/// of the recorded frames; coarse ones first, at most a few thousand.
/// @param finest_level  the least level of a tile
/// @param reach_per_depth  half the side of the square of ground around such a point, relative to
/// the
///                         depth along the axis: 1 for a field of view of 90 degrees
[[nodiscard]] std::vector<terrain::TileId> tiles_along(const RunTimeline& timeline,
                                                       const terrain::TileSource& tiles,
                                                       int finest_level,
                                                       double reach_per_depth);

}  // namespace overfly::server
