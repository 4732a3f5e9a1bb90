#include "terrain/map_plane.hpp"

#include <cmath>

#include "core/pose.hpp"

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

Result<MapPlane> MapPlane::create(const OGRSpatialReference& crs,
                                  double scale_x,
                                  double scale_y,
                                  double x_near,
                                  const std::string& what) {
  MapPlane plane;
  plane.crs_ = crs;
  plane.scale_x_ = scale_x;
  plane.scale_y_ = scale_y;
  if (const auto turn = full_turn_of(crs)) plane.turn_ = Turn{*turn, x_near};
  auto forward = CrsTransform::create(crs, wgs84_crs(), what);
  if (!forward) return forward.error();
  auto backward = CrsTransform::create(wgs84_crs(), crs, what);
  if (!backward) return backward.error();
  plane.to_wgs84_ = *forward;
  plane.from_wgs84_ = *backward;
  return plane;
}

bool MapPlane::geodetic_from_map(Eigen::Matrix2Xd& points) const {
  points.row(0) /= scale_x_;
  points.row(1) /= scale_y_;
  if (!to_wgs84_->apply(points)) return false;
  points *= rad_from_deg(1.0);
  return true;
}

bool MapPlane::map_from_geodetic(Eigen::Matrix2Xd& points) const {
  points *= deg_from_rad(1.0);
  if (!from_wgs84_->apply(points)) return false;
  for (Eigen::Index i = 0; turn_ && i < points.cols(); ++i) turn_->apply(points(0, i));
  points.row(0) *= scale_x_;
  points.row(1) *= scale_y_;
  return true;
}

bool MapPlane::to_crs(const CrsTransform& crs_from_wgs84, Eigen::Matrix2Xd& points) const {
  if (!geodetic_from_map(points)) return false;
  points *= deg_from_rad(1.0);
  return crs_from_wgs84.apply(points);
}

}  // namespace overfly::terrain
