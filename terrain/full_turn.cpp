#include "terrain/full_turn.hpp"

#include <algorithm>
#include <array>

#include "terrain/map_plane.hpp"

namespace overfly::terrain {
namespace {

using Turns = std::vector<std::optional<Turn>>;

/// A range of x.
struct Span {
  double low = 0.0;
  double high = 0.0;

  void extend(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
};

Span columns_of(const Georeference& place, int width_px, int height_px) {
  std::array<double, 4> x{};
  double y = 0.0;
  for (int corner = 0; corner < 4; ++corner) {
    place.transform.crs_from_pixel(
        (corner & 1) * width_px, (corner >> 1) * height_px, x[static_cast<std::size_t>(corner)], y);
  }
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  return {*low, *high};
}

/// The area in x of the raster's CRS, unwrapped around its middle; empty where PROJ has no answer.
std::optional<Span> span_of(const MapPlane& plane,
                            const MapRect& area,
                            const CrsTransform& crs_from_wgs84,
                            double turn) {
  constexpr int kSteps = 8;
  Eigen::Matrix2Xd points(2, (kSteps + 1) * (kSteps + 1));
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      points.col(j * (kSteps + 1) + i) << area.x_min + (area.x_max - area.x_min) * i / kSteps,
          area.y_min + (area.y_max - area.y_min) * j / kSteps;
    }
  }
  if (!plane.to_crs(crs_from_wgs84, points)) return std::nullopt;
  const double middle = points(0, points.cols() / 2);
  Span span{middle, middle};
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    span.extend(unwrapped(points(0, i), middle, turn));
  }
  return span;
}

}  // namespace

std::optional<double> full_turn_of(const OGRSpatialReference& crs) {
  if (crs.IsGeographic() != 0) return 2.0 * M_PI / crs.GetAngularUnits();
  // A projection is cylindrical where the equator is a line of constant y, and x grows evenly.
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

Result<Turns> turns_over(const MapPlane& plane,
                         const MapRect& area,
                         const Georeference& place,
                         int width_px,
                         int height_px,
                         const std::string& what) {
  const std::optional<double> turn = full_turn_of(place.crs);
  if (!turn) return Turns{std::nullopt};
  const auto crs_from_wgs84 = CrsTransform::create(wgs84_crs(), place.crs, what);
  if (!crs_from_wgs84) return crs_from_wgs84.error();
  const std::optional<Span> span = span_of(plane, area, **crs_from_wgs84, *turn);
  const Span columns = columns_of(place, width_px, height_px);
  if (!span) return Turns{Turn{*turn, columns.middle()}};
  Turns turns;
  const double first = std::ceil((columns.low - span->high) / *turn);
  const double last = std::floor((columns.high - span->low) / *turn);
  for (double k = first; k <= last; ++k) {
    turns.emplace_back(Turn{*turn, span->middle() + k * *turn});
  }
  if (turns.empty()) {
    turns.emplace_back(Turn{*turn, unwrapped(span->middle(), columns.middle(), *turn)});
  }
  return turns;
}

}  // namespace overfly::terrain
