// Inside terrain only: detects files whose declared place is probably wrong.
#pragma once

#include <optional>
#include <string>

#include "terrain/raster/georeference.hpp"

namespace overfly::terrain {

/// A warning if the raster's centre lies far outside the area of use of its coordinate reference
/// system, a sign of coordinates in another unit or zone.
[[nodiscard]] std::optional<std::string> place_doubt(const Georeference& place,
                                                     int width_px,
                                                     int height_px,
                                                     const std::string& file);

}  // namespace overfly::terrain
