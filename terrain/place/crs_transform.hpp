// Inside terrain only: coordinate reference systems and the transformations between them, by PROJ.
#pragma once

#include <ogr_spatialref.h>

#include <Eigen/Core>
#include <memory>
#include <mutex>
#include <string>

#include "core/result.hpp"

namespace overfly::terrain {

/// Transforms coordinates from one CRS to another with PROJ. Thread-safe (serialised).
class CrsTransform {
 public:
  /// Errors: kInvalidArgument if PROJ knows no transformation; `what` names the file.
  static Result<std::shared_ptr<const CrsTransform>> create(const OGRSpatialReference& from,
                                                            const OGRSpatialReference& to,
                                                            const std::string& what);
  /// In place, x = east or longitude first. False if any point cannot be transformed.
  bool apply(Eigen::Matrix2Xd& points) const;

 private:
  explicit CrsTransform(OGRCoordinateTransformation* transformation)
      : transformation_(transformation) {}
  mutable std::mutex mutex_;
  std::unique_ptr<OGRCoordinateTransformation> transformation_;
};

/// WGS84 longitude and latitude in degrees.
[[nodiscard]] OGRSpatialReference wgs84_crs();
/// Transverse Mercator with scale 1 at a point.
[[nodiscard]] OGRSpatialReference transverse_mercator_at(double lat_rad, double lon_rad);

}  // namespace overfly::terrain
