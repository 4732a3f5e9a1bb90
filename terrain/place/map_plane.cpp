#include "terrain/place/map_plane.hpp"

#include "core/motion/pose.hpp"

namespace overfly::terrain {

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
