// Lines of a plot: points with gaps, few enough to draw.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "server/report/plot/ticks.hpp"

namespace overfly::server::plot {

/// A y that is not finite is a gap: the line ends before it and begins again behind it.
struct Point {
  double x = 0.0;
  double y = 0.0;
  [[nodiscard]] bool is_gap() const;
};

inline constexpr double kGap = std::numeric_limits<double>::quiet_NaN();

/// Styles of estimates: four colours, each solid, dashed and dotted.
inline constexpr int kEstimateStyles = 12;

struct Series {
  std::string label;
  int style = 0;  ///< 0 = the truth, k = the k-th estimate: colour and dashes
  std::vector<Point> points;
};

/// The most points of a line in a report.
inline constexpr std::size_t kMaxPoints = 2000;

/// At most `max_points` of the points, in their order: the line is cut into equal stretches, of
/// each of which the first and the last point and those with the extreme values are kept. No peak
/// is lost. A stretch with gaps keeps one of them; gaps longer than a stretch are kept whole. Lines
/// with fewer points stay as they are.
[[nodiscard]] std::vector<Point> decimated(const std::vector<Point>& points,
                                           std::size_t max_points = kMaxPoints);

/// The same line of an angle with gaps where it steps from one end of its period to the other.
[[nodiscard]] std::vector<Point> with_gaps_at_wraps(const std::vector<Point>& points,
                                                    double period);

/// The values' ranges; low > high if there is no point.
[[nodiscard]] Range x_range_of(const std::vector<Series>& series);
[[nodiscard]] Range y_range_of(const std::vector<Series>& series);

}  // namespace overfly::server::plot
