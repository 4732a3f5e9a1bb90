// Inside terrain only: coordinates that wrap after a full turn of the earth. A place near 180 deg
// has different longitudes in files that count to 180 and in files that count to 360.
#pragma once

#include <ogr_spatialref.h>

#include <cmath>
#include <optional>

namespace overfly::terrain {

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

}  // namespace overfly::terrain
