#include "server/report/plot/series.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace overfly::server::plot {
namespace {

constexpr Range kNothing{std::numeric_limits<double>::infinity(),
                         -std::numeric_limits<double>::infinity()};

/// Points that a stretch keeps: both ends, the extremes in x and y, and a gap.
constexpr std::size_t kKept = 7;

/// Keeps the extremes of the points [begin, end) in their order.
void keep_extremes(const std::vector<Point>& points,
                   std::size_t begin,
                   std::size_t end,
                   std::vector<Point>& kept) {
  std::optional<std::size_t> gap;
  std::optional<std::array<std::size_t, kKept - 1>> picked;
  for (std::size_t i = begin; i < end; ++i) {
    if (points[i].is_gap()) {
      if (!gap) gap = i;
      continue;
    }
    if (!picked) picked = {i, i, i, i, i, i};
    auto& [first, last, left, right, low, high] = *picked;
    last = i;
    if (points[i].x < points[left].x) left = i;
    if (points[i].x > points[right].x) right = i;
    if (points[i].y < points[low].y) low = i;
    if (points[i].y > points[high].y) high = i;
  }
  std::vector<std::size_t> chosen;
  if (picked) chosen.assign(picked->begin(), picked->end());
  if (gap) chosen.push_back(*gap);
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  for (const std::size_t i : chosen) {
    const bool second_gap = points[i].is_gap() && !kept.empty() && kept.back().is_gap();
    if (!second_gap) kept.push_back(points[i]);
  }
}

/// In a line over time the extremes in x are the ends.
bool advances(const std::vector<Point>& points) {
  double last = -std::numeric_limits<double>::infinity();
  for (const Point& point : points) {
    if (point.is_gap()) continue;
    if (point.x < last) return false;
    last = point.x;
  }
  return true;
}

Range range_of(const std::vector<Series>& series, double Point::*coordinate) {
  Range range = kNothing;
  for (const Series& line : series) {
    for (const Point& point : line.points) {
      if (point.is_gap()) continue;
      range.low = std::min(range.low, point.*coordinate);
      range.high = std::max(range.high, point.*coordinate);
    }
  }
  return range;
}

}  // namespace

bool Point::is_gap() const { return !std::isfinite(y) || !std::isfinite(x); }

std::vector<Point> decimated(const std::vector<Point>& points, std::size_t max_points) {
  if (points.size() <= max_points) return points;
  const std::size_t kept_each = advances(points) ? kKept - 2 : kKept;
  const std::size_t stretches = std::max<std::size_t>(1, max_points / kept_each);
  std::vector<Point> kept;
  for (std::size_t i = 0; i < stretches; ++i) {
    keep_extremes(points, i * points.size() / stretches, (i + 1) * points.size() / stretches, kept);
  }
  return kept;
}

std::vector<Point> with_gaps_at_wraps(const std::vector<Point>& points, double period) {
  std::vector<Point> line;
  line.reserve(points.size());
  for (const Point& point : points) {
    const bool wraps = !line.empty() && !line.back().is_gap() && !point.is_gap() &&
                       std::abs(point.y - line.back().y) > 0.5 * period;
    if (wraps) line.push_back({point.x, kGap});
    line.push_back(point);
  }
  return line;
}

Range x_range_of(const std::vector<Series>& series) { return range_of(series, &Point::x); }
Range y_range_of(const std::vector<Series>& series) { return range_of(series, &Point::y); }

}  // namespace overfly::server::plot
