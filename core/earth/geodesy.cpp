#include "core/earth/geodesy.hpp"

#include <GeographicLib/Geocentric.hpp>
#include <cmath>

#include "core/motion/pose.hpp"

#ifdef __FAST_MATH__
#error "geodesy needs IEEE arithmetic: build without -ffast-math"
#endif

namespace overfly {
namespace {

/// R_enu_ecef at a point: rows are east, north and up expressed in ECEF.
Eigen::Matrix3d R_enu_ecef_at(const Geodetic& point) {
  const double sin_lat = std::sin(point.lat_rad);
  const double cos_lat = std::cos(point.lat_rad);
  const double sin_lon = std::sin(point.lon_rad);
  const double cos_lon = std::cos(point.lon_rad);
  Eigen::Matrix3d R;
  R << -sin_lon, cos_lon, 0.0,                          //
      -sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat,  //
      cos_lat * cos_lon, cos_lat * sin_lon, sin_lat;
  return R;
}

}  // namespace

Geodetic geodetic_from_deg(double lat_deg, double lon_deg, double alt_ellipsoid_m) {
  return {rad_from_deg(lat_deg), rad_from_deg(lon_deg), alt_ellipsoid_m};
}

Eigen::Vector3d ecef_from_geodetic(const Geodetic& point) {
  Eigen::Vector3d p_ecef;
  GeographicLib::Geocentric::WGS84().Forward(deg_from_rad(point.lat_rad),
                                             deg_from_rad(point.lon_rad),
                                             point.alt_ellipsoid_m,
                                             p_ecef.x(),
                                             p_ecef.y(),
                                             p_ecef.z());
  return p_ecef;
}

Geodetic geodetic_from_ecef(const Eigen::Vector3d& p_ecef) {
  double lat_deg = 0.0;
  double lon_deg = 0.0;
  double alt_m = 0.0;
  GeographicLib::Geocentric::WGS84().Reverse(
      p_ecef.x(), p_ecef.y(), p_ecef.z(), lat_deg, lon_deg, alt_m);
  return geodetic_from_deg(lat_deg, lon_deg, alt_m);
}

LocalFrame::LocalFrame(const Geodetic& origin)
    : origin_(origin),
      origin_ecef_(ecef_from_geodetic(origin)),
      R_world_ecef_(R_enu_ecef_at(origin)) {}

Eigen::Vector3d LocalFrame::world_from_ecef(const Eigen::Vector3d& p_ecef) const {
  return R_world_ecef_ * (p_ecef - origin_ecef_);
}

Eigen::Vector3d LocalFrame::ecef_from_world(const Eigen::Vector3d& p_world) const {
  return R_world_ecef_.transpose() * p_world + origin_ecef_;
}

Eigen::Vector3d LocalFrame::world_from_geodetic(const Geodetic& point) const {
  return world_from_ecef(ecef_from_geodetic(point));
}

Geodetic LocalFrame::geodetic_from_world(const Eigen::Vector3d& p_world) const {
  return geodetic_from_ecef(ecef_from_world(p_world));
}

Eigen::Quaterniond LocalFrame::R_world_enu_at(const Geodetic& point) const {
  const Eigen::Matrix3d R = R_world_ecef_ * R_enu_ecef_at(point).transpose();
  return Eigen::Quaterniond(R).normalized();
}

}  // namespace overfly
