// Inside terrain only: the height of the ground above the ellipsoid over the map plane.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "terrain/elevation_raster.hpp"
#include "terrain/height_grid.hpp"
#include "terrain/map_plane.hpp"
#include "terrain/smooth_map.hpp"
#include "terrain/world.hpp"

namespace overfly::terrain {

/// Continuous everywhere; beyond the posts it goes on with the edge's value. Immutable.
class ElevationModel {
 public:
  static ElevationModel flat(double height_m);

  /// Loads the layers' posts over `area` of the map plane. One layer is sampled at its own posts;
  /// several are laid onto one grid of the finest spacing, the first that has data wins.
  /// @param imagery  the part of the map where missing elevation is worth a warning
  /// Errors: as ElevationRaster::load; kInvalidArgument if none overlaps the imagery.
  static Result<ElevationModel> load(const std::vector<ElevationLayer>& layers,
                                     const MapPlane& plane,
                                     const MapRect& imagery,
                                     const MapRect& area,
                                     std::vector<std::string>& warnings);

  /// Ellipsoidal height [m].
  [[nodiscard]] double height_m(double x_map_m, double y_map_m) const;
  /// Lowest and highest ellipsoidal height [m].
  [[nodiscard]] Eigen::Vector2d range_m() const { return range_m_; }
  /// Distance between posts on the map [m]; 0 for flat ground.
  [[nodiscard]] double spacing_m() const { return spacing_m_; }

 private:
  static Result<ElevationModel> merge(const std::vector<ElevationRaster>& rasters,
                                      const MapRect& area,
                                      std::vector<std::string>& warnings);
  Status finish(HeightGrid grid, const std::string& what, std::vector<std::string>& warnings);

  HeightGrid grid_;
  std::optional<SmoothMap<2>> post_from_map_;
  double flat_height_m_ = 0.0;
  double spacing_m_ = 0.0;
  Eigen::Vector2d range_m_{0.0, 0.0};
};

}  // namespace overfly::terrain
