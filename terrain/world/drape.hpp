// Stretching of vertically photographed imagery that is draped over slopes.
#pragma once

#include "terrain/tile_source.hpp"

namespace overfly::terrain {

/// From this stretch on texels count as smeared: a slope of 60 deg.
inline constexpr double kSmearedStretch = 2.0;

/// Length of the ground along its steepest line divided by that line's length on the map: 1 /
/// cos(slope), >= 1. The slope is measured between points a quarter of a texel from the place, at
/// least 0.1 m.
[[nodiscard]] double drape_stretch(const TileSource& tiles, double x_map_m, double y_map_m);

/// Stretch of a surface with this normal (any length but zero), world frame.
[[nodiscard]] double drape_stretch(const Eigen::Vector3d& normal);

/// Fraction of the imagery's area on the map that is stretched beyond `limit`, from `samples` x
/// `samples` places; 0 if there is no imagery.
[[nodiscard]] double stretched_share(const TileSource& tiles,
                                     double limit = kSmearedStretch,
                                     int samples = 200);

}  // namespace overfly::terrain
