#include "terrain/place/crs_transform.hpp"

#include "core/motion/pose.hpp"
#include "terrain/raster/gdal_messages.hpp"

namespace overfly::terrain {

Result<std::shared_ptr<const CrsTransform>> CrsTransform::create(const OGRSpatialReference& from,
                                                                 const OGRSpatialReference& to,
                                                                 const std::string& what) {
  const GdalMessages messages;
  OGRCoordinateTransformation* made = OGRCreateCoordinateTransformation(&from, &to);
  if (made == nullptr) {
    return Error{
        ErrorCode::kInvalidArgument,
        what + ": its coordinate reference system cannot be related to WGS84: " + messages.text()};
  }
  return std::shared_ptr<const CrsTransform>(new CrsTransform(made));
}

bool CrsTransform::apply(Eigen::Matrix2Xd& points) const {
  Eigen::VectorXd x = points.row(0);
  Eigen::VectorXd y = points.row(1);
  {
    const std::lock_guard lock(mutex_);
    const GdalMessages quiet;
    if (transformation_->Transform(static_cast<int>(x.size()), x.data(), y.data()) == 0) {
      return false;
    }
  }
  points.row(0) = x;
  points.row(1) = y;
  return points.allFinite();
}

OGRSpatialReference wgs84_crs() {
  OGRSpatialReference crs;
  crs.importFromEPSG(4326);
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

OGRSpatialReference transverse_mercator_at(double lat_rad, double lon_rad) {
  OGRSpatialReference crs;
  crs.SetProjCS("Overfly map plane");
  crs.SetWellKnownGeogCS("WGS84");
  crs.SetTM(deg_from_rad(lat_rad), deg_from_rad(lon_rad), 1.0, 0.0, 0.0);
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

}  // namespace overfly::terrain
