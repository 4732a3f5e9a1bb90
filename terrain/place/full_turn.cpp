#include "terrain/place/full_turn.hpp"

#include <cmath>

#include "terrain/place/crs_transform.hpp"

namespace overfly::terrain {
std::optional<double> full_turn_of(const OGRSpatialReference& crs) {
  if (crs.IsGeographic() != 0) return 2.0 * M_PI / crs.GetAngularUnits();
  // A projection is cylindrical if the equator is a line of constant y along which x increases
  // evenly.
  const auto transform = CrsTransform::create(wgs84_crs(), crs, "");
  if (!transform) return std::nullopt;
  const double central_deg = crs.GetNormProjParm(SRS_PP_CENTRAL_MERIDIAN, 0.0);
  constexpr double kFarDeg = 90.0;
  Eigen::Matrix2Xd points(2, 4);
  points << central_deg, central_deg + 1.0, central_deg + kFarDeg, central_deg, 0.0, 0.0, 0.0, 1.0;
  if (!(*transform)->apply(points)) return std::nullopt;
  const Eigen::Vector2d degree = points.col(1) - points.col(0);
  const Eigen::Vector2d far = points.col(2) - points.col(0);
  const double length = degree.norm();
  constexpr double kTolerance = 1e-6;
  const bool even = (far - kFarDeg * degree).norm() < kTolerance * kFarDeg * length;
  const bool along_x = std::abs(degree.y()) < kTolerance * length && degree.x() > 0.0;
  const bool upright = std::abs(points(0, 3) - points(0, 0)) < kTolerance * length;
  if (!even || !along_x || !upright) return std::nullopt;
  return 360.0 * degree.x();
}

}  // namespace overfly::terrain
