// Inside terrain only: the place of a raster on the earth.
#pragma once

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <filesystem>
#include <optional>
#include <string>

#include "core/result.hpp"

namespace overfly::terrain {

/// The six numbers of an affine georeference, pixel corners at integers:
/// X = g0 + g1 px + g2 py, Y = g3 + g4 px + g5 py.
struct GeoTransform {
  double g[6] = {0, 1, 0, 0, 0, 1};

  [[nodiscard]] bool north_up() const {
    return g[2] == 0.0 && g[4] == 0.0 && g[1] > 0.0 && g[5] < 0.0;
  }
  void crs_from_pixel(double px, double py, double& x, double& y) const;
  void pixel_from_crs(double x, double y, double& px, double& py) const;
};

/// Checked georeference of a raster.
struct Georeference {
  GeoTransform transform;
  OGRSpatialReference crs;  ///< traditional axis order: x = east or longitude
};

/// Reads the georeference; `crs_override` ("EPSG:2994", see check_crs_text) is used if the file has
/// none, or a local one without a place on the earth.
/// @param said  GDAL's messages from opening the file
/// Errors: kInvalidArgument naming the file: no CRS, no or degenerate transform, a place outside
/// the CRS's range.
[[nodiscard]] Result<Georeference> read_georeference(GDALDataset& dataset,
                                                     const std::filesystem::path& file,
                                                     const std::optional<std::string>& crs_override,
                                                     const std::string& said);

/// Errors: kInvalidArgument for implausible pixel sizes: below 1 mm or above 100 km.
[[nodiscard]] Status check_pixel_size(const Georeference& place, const std::string& file);

}  // namespace overfly::terrain
