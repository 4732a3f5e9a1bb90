#include "calibration/coverage.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/pose.hpp"

namespace overfly::calibration {
namespace {

/// Twice the area of a triangle, positive for a clockwise turn in the image.
double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double clamped(double value) { return std::clamp(value, 0.0, 1.0); }

}  // namespace

ViewMeasures measures_of(const BoardView& view, const Board& board, int width_px, int height_px) {
  const auto corner = [&view](int id) -> const Eigen::Vector2d& {
    return view.corners[static_cast<std::size_t>(id)].pixel;
  };
  const Eigen::Vector2d& a = corner(0);
  const Eigen::Vector2d& b = corner(board.cols - 1);
  const Eigen::Vector2d& c = corner(board.corner_count() - 1);
  const Eigen::Vector2d& d = corner(board.corner_count() - board.cols);
  const double area = 0.5 * std::abs(turn(c - a, d - b));
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const BoardCorner& each : view.corners) mean += each.pixel;
  mean /= static_cast<double>(view.corners.size());
  // A board cannot be centred closer to the edge than half its own size.
  const double border = std::sqrt(area);
  ViewMeasures measures;
  measures.x = clamped((mean.x() - 0.5 * border) / std::max(1.0, width_px - border));
  measures.y = clamped((mean.y() - 0.5 * border) / std::max(1.0, height_px - border));
  measures.size = clamped(std::sqrt(area / (static_cast<double>(width_px) * height_px)));
  const Eigen::Vector2d u = a - b;
  const Eigen::Vector2d v = c - b;
  const double angle = std::atan2(std::abs(turn(u, v)), u.dot(v));
  measures.skew = clamped(2.0 * std::abs(0.5 * kPi - angle));
  return measures;
}

std::vector<CoverageBar> coverage_bars(const std::vector<ViewMeasures>& views) {
  struct Measure {
    const char* name;
    double ViewMeasures::*value;
    bool from_zero;
    double enough;
  };
  constexpr Measure kMeasures[] = {{"x", &ViewMeasures::x, false, 0.7},
                                   {"y", &ViewMeasures::y, false, 0.7},
                                   {"size", &ViewMeasures::size, true, 0.4},
                                   {"skew", &ViewMeasures::skew, true, 0.5}};
  std::vector<CoverageBar> bars;
  for (const Measure& measure : kMeasures) {
    CoverageBar bar{measure.name, 0.0, 0.0, 0.0};
    if (!views.empty()) {
      const auto [low, high] =
          std::minmax_element(views.begin(), views.end(), [&](const auto& a, const auto& b) {
            return a.*measure.value < b.*measure.value;
          });
      bar.min = measure.from_zero ? 0.0 : (*low).*measure.value;
      bar.max = (*high).*measure.value;
      bar.progress = clamped((bar.max - bar.min) / measure.enough);
    }
    bars.push_back(bar);
  }
  return bars;
}

double mean_shift_px(const BoardView& a, const BoardView& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.corners.size(); ++i) {
    sum += (a.corners[i].pixel - b.corners[i].pixel).norm();
  }
  return sum / static_cast<double>(a.corners.size());
}

}  // namespace overfly::calibration
