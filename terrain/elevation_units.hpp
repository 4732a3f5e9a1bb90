// Inside terrain only: what the numbers of an elevation file mean.
#pragma once

#include <string>
#include <vector>

#include "terrain/gdal_dataset.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {

/// Metres per unit of the heights: said by the manifest, the band, or the vertical CRS; doubts go
/// to `warnings`.
[[nodiscard]] double height_unit_m(GDALDataset& dataset,
                                   const ElevationLayer& layer,
                                   const OGRSpatialReference& crs,
                                   std::vector<std::string>& warnings);

/// The manifest's datum, else that of the file's vertical CRS.
[[nodiscard]] VerticalDatum height_datum(const ElevationLayer& layer,
                                         const OGRSpatialReference& crs);

/// Errors: kInvalidArgument if the file is a picture (colours, a palette) and no heights; a single
/// band of 8 bits is a warning.
[[nodiscard]] Status check_height_band(GDALDataset& dataset,
                                       const std::string& file,
                                       std::vector<std::string>& warnings);

}  // namespace overfly::terrain
