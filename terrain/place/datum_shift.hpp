// Inside terrain only: accuracy of the relation between a CRS's datum and WGS84 on this machine.
#pragma once

#include <optional>
#include <string>

#include "terrain/raster/gdal_dataset.hpp"

namespace overfly::terrain {

/// A warning if the best relation available to PROJ at a place (x, y in the CRS) is worse than 5 m
/// or only approximate, because a grid is missing. (NAD83 and WGS84 agree within 4 m by
/// definition.)
[[nodiscard]] std::optional<std::string> datum_shift_doubt(const OGRSpatialReference& crs,
                                                           double x,
                                                           double y,
                                                           const std::string& file);

}  // namespace overfly::terrain
