#include "terrain/place/raster_turns.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace overfly::terrain {
namespace {

using Turns = std::vector<std::optional<Turn>>;

/// A range of x.
struct XRange {
  double low = 0.0;
  double high = 0.0;

  void extend(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
};

XRange columns_of(const Georeference& place, int width_px, int height_px) {
  std::array<double, 4> x{};
  double y = 0.0;
  for (int corner = 0; corner < 4; ++corner) {
    place.transform.crs_from_pixel(
        (corner & 1) * width_px, (corner >> 1) * height_px, x[static_cast<std::size_t>(corner)], y);
  }
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  return {*low, *high};
}

/// The area in x of the raster's CRS, unwrapped around its centre; empty if PROJ cannot transform
/// it.
std::optional<XRange> span_of(const MapPlane& plane,
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
  XRange span{middle, middle};
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    span.extend(unwrapped(points(0, i), middle, turn));
  }
  return span;
}

}  // namespace

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
  const std::optional<XRange> span = span_of(plane, area, **crs_from_wgs84, *turn);
  const XRange columns = columns_of(place, width_px, height_px);
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
