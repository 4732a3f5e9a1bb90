// Inside terrain only: unit and datum of an elevation file's values.
#pragma once

#include <string>
#include <vector>

#include "terrain/raster/gdal_dataset.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {

/// Metres per unit of the heights, from the manifest, the band, or the vertical CRS; doubts are
/// added to `warnings`.
[[nodiscard]] double height_unit_m(GDALDataset& dataset,
                                   const ElevationLayer& layer,
                                   const OGRSpatialReference& crs,
                                   std::vector<std::string>& warnings);

/// The vertical datum of heights.
struct HeightDatum {
  VerticalDatum datum = VerticalDatum::kUnknown;
  std::string named;  ///< the file's own name of its vertical datum; empty if it names none
};

/// The manifest's datum, or else that of the file's vertical CRS; a geographic or projected CRS
/// with three axes (EPSG:4979) has ellipsoidal heights.
[[nodiscard]] HeightDatum height_datum(const ElevationLayer& layer, const OGRSpatialReference& crs);

/// Errors: kInvalidArgument if the file is an image (colours, a palette) and not elevation; a
/// single band of 8 bits causes a warning.
[[nodiscard]] Status check_height_band(GDALDataset& dataset,
                                       const std::string& file,
                                       std::vector<std::string>& warnings);

}  // namespace overfly::terrain
