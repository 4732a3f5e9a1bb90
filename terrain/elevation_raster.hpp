// Inside terrain only: one elevation file as ellipsoidal heights in metres at its own posts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "terrain/height_grid.hpp"
#include "terrain/map_plane.hpp"
#include "terrain/smooth_map.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {

struct ElevationRaster {
  std::string file;
  HeightGrid grid;  ///< NaN where the file has no data
  SmoothMap<2> post_from_map;
  double spacing_m = 0.0;  ///< between posts on the map, at the area's middle

  /// Reads the posts over `area` of the map plane and converts them to metres above the ellipsoid.
  /// Doubts about unit, datum and implausible values go to `warnings`.
  /// Errors: kNotFound, kUnreadable, kInvalidArgument naming the file.
  static Result<ElevationRaster> load(const ElevationLayer& layer,
                                      const MapPlane& plane,
                                      const MapRect& area,
                                      std::vector<std::string>& warnings);

  /// True within half a post of the file's posts.
  [[nodiscard]] bool covers(double x_map_m, double y_map_m) const;
  /// NaN outside and where there is no data.
  [[nodiscard]] double height_m(double x_map_m, double y_map_m) const;
};

}  // namespace overfly::terrain
