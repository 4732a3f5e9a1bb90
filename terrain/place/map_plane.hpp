// Inside terrain only: the map plane, a projected coordinate system scaled to metres, and its
// exact relation to WGS84 and to other coordinate systems.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>

#include "core/earth/geodesy.hpp"
#include "terrain/place/crs_transform.hpp"
#include "terrain/place/full_turn.hpp"

namespace overfly::terrain {

/// The CRS of the tiles with the factors that convert its units to map metres.
class MapPlane {
 public:
  /// x_map = scale_x X, y_map = scale_y Y.
  /// @param x_near  for a CRS whose X is periodic: map points lie within half a turn of it
  static Result<MapPlane> create(const OGRSpatialReference& crs,
                                 double scale_x,
                                 double scale_y,
                                 double x_near,
                                 const std::string& what);

  /// Longitude, latitude [rad] of map points, longitudes as PROJ returns them: they may jump by a
  /// turn at the antimeridian. False if any point cannot be transformed.
  bool geodetic_from_map(Eigen::Matrix2Xd& points) const;
  /// The inverse.
  bool map_from_geodetic(Eigen::Matrix2Xd& points) const;
  /// Transforms map points to another CRS in its own units.
  bool to_crs(const CrsTransform& crs_from_wgs84, Eigen::Matrix2Xd& points) const;

  [[nodiscard]] const OGRSpatialReference& crs() const { return crs_; }
  [[nodiscard]] double scale_x() const { return scale_x_; }
  [[nodiscard]] double scale_y() const { return scale_y_; }

 private:
  OGRSpatialReference crs_;
  double scale_x_ = 1.0;
  double scale_y_ = 1.0;
  std::optional<Turn> turn_;
  std::shared_ptr<const CrsTransform> to_wgs84_;
  std::shared_ptr<const CrsTransform> from_wgs84_;
};

}  // namespace overfly::terrain
