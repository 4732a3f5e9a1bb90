// Inside terrain only: coordinates that wrap after a full turn of the earth. A place near 180 deg
// has different longitudes in files that count to 180 and in files that count to 360.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "terrain/gdal_dataset.hpp"
#include "terrain/smooth_map.hpp"

namespace overfly::terrain {

class MapPlane;

/// Of the values x + k turn the one nearest to `near`.
[[nodiscard]] inline double unwrapped(double x, double near, double turn) {
  return x + turn * std::round((near - x) / turn);
}

/// Period of x after which a coordinate system returns to the same meridian: 360 deg in its unit,
/// or the equator's length of a cylindrical projection; empty if x is not periodic.
[[nodiscard]] std::optional<double> full_turn_of(const OGRSpatialReference& crs);

/// Selects one of the x values of the same meridian: the one within half a turn of `near`.
struct Turn {
  double length = 0.0;
  double near = 0.0;

  void apply(double& x) const { x = unwrapped(x, near, length); }
};

/// The turns on which a raster's columns meet an area of the map: one, or two if a raster around
/// the whole earth has its seam there. Empty values for a CRS without turns.
/// Errors: kInvalidArgument if PROJ knows no transformation; `what` names the file.
[[nodiscard]] Result<std::vector<std::optional<Turn>>> turns_over(const MapPlane& plane,
                                                                  const MapRect& area,
                                                                  const Georeference& place,
                                                                  int width_px,
                                                                  int height_px,
                                                                  const std::string& what);

}  // namespace overfly::terrain
