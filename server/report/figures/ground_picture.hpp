// A picture of the ground from straight above, north up, from a world's own imagery.
#pragma once

#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::server::report {

/// A rectangle of the world frame [m].
struct GroundExtent {
  double east_low_m = 0.0;
  double east_high_m = 0.0;
  double north_low_m = 0.0;
  double north_high_m = 0.0;
};

/// The largest picture [px].
inline constexpr int kMaxGroundPx = 2048;

/// RGB; row 0 is in the north, columns go east. Each pixel shows the ground on the vertical line
/// through its centre, bilinear in the level of the imagery whose texels are at most as large as a
/// pixel. Ground without imagery is terrain::kVoidRgb.
/// @pre finite extent, low < high; sizes in [1, kMaxGroundPx]
/// Errors: as terrain::TileSource::tile.
[[nodiscard]] Result<Image> ground_picture(const terrain::TileSource& tiles,
                                           const GroundExtent& extent,
                                           int width_px,
                                           int height_px,
                                           const terrain::Cancelled& cancelled = {});

}  // namespace overfly::server::report
