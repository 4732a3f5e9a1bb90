#include "calibration/coverage.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "calibration/solver/plane_homography.hpp"
#include "core/motion/pose.hpp"

namespace overfly::calibration {
namespace {

/// Twice the area of a triangle, positive for a clockwise turn in the image.
double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double clamped(double value) { return std::clamp(value, 0.0, 1.0); }

/// The images of the corners of the smallest rectangle on the board around the view's corners.
std::array<Eigen::Vector2d, 4> outline(const BoardView& view, const Board& board) {
  Eigen::Vector2d low(board.cols, board.rows);
  Eigen::Vector2d high(0.0, 0.0);
  std::vector<PlanePair> pairs;
  for (const BoardCorner& corner : view.corners) {
    const Eigen::Vector2d at(corner.id % board.cols, corner.id / board.cols);
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
    pairs.push_back({at, corner.pixel});
  }
  std::array<Eigen::Vector2d, 4> corners = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  const auto H = homography(pairs);
  for (Eigen::Vector2d& corner : corners) {
    const auto seen = std::find_if(
        pairs.begin(), pairs.end(), [&](const PlanePair& pair) { return pair.plane == corner; });
    if (seen != pairs.end()) {
      corner = seen->image;
    } else if (H) {
      corner = Eigen::Vector3d(*H * corner.homogeneous()).hnormalized();
    }
  }
  return corners;
}

}  // namespace

ViewMeasures measures_of(const BoardView& view, const Board& board, int width_px, int height_px) {
  const auto [a, b, c, d] = outline(view, board);
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

double novelty(const ViewMeasures& a, const ViewMeasures& b) {
  return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.size - b.size) +
         std::abs(a.skew - b.skew);
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
  int shared = 0;
  auto other = b.corners.begin();
  for (const BoardCorner& corner : a.corners) {
    while (other != b.corners.end() && other->id < corner.id) ++other;
    if (other == b.corners.end()) break;
    if (other->id != corner.id) continue;
    sum += (corner.pixel - other->pixel).norm();
    ++shared;
  }
  return shared == 0 ? std::numeric_limits<double>::infinity() : sum / shared;
}

}  // namespace overfly::calibration
