// Inside terrain only: how well a coordinate reference system's datum is related to WGS84 here.
#pragma once

#include <optional>
#include <string>

#include "terrain/gdal_dataset.hpp"

namespace overfly::terrain {

/// A warning when the best relation that PROJ can use at a place (x, y in the CRS) is worse than
/// 5 m, or a mere guess, for want of a grid. (NAD83 and WGS84 are within 4 m by definition.)
[[nodiscard]] std::optional<std::string> datum_shift_doubt(const OGRSpatialReference& crs,
                                                           double x,
                                                           double y,
                                                           const std::string& file);

}  // namespace overfly::terrain
