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

/// What heights count from.
struct HeightDatum {
  VerticalDatum datum = VerticalDatum::kUnknown;
  std::string named;  ///< the file's vertical datum in its own words; empty where it names none
};

/// The manifest's datum, else that of the file's vertical CRS; a geographic or projected CRS with
/// three axes (EPSG:4979) has ellipsoidal heights.
[[nodiscard]] HeightDatum height_datum(const ElevationLayer& layer, const OGRSpatialReference& crs);

/// Errors: kInvalidArgument if the file is a picture (colours, a palette) and no heights; a single
/// band of 8 bits is a warning.
[[nodiscard]] Status check_height_band(GDALDataset& dataset,
                                       const std::string& file,
                                       std::vector<std::string>& warnings);

}  // namespace overfly::terrain
