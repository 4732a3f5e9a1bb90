#include "server/experiments/hunt/point_search.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "server/experiments/drawn_numbers.hpp"
#include "server/experiments/hunt/box_minimum.hpp"
#include "server/experiments/hunt/gaussian_process.hpp"

namespace overfly::server::experiments {
namespace {

using Point = Eigen::VectorXd;

/// Logarithm of the expected improvement of `lowest`, divided by the deviation (Jones, Schonlau,
/// Welch 1998, eq. 15). The logarithm tells points apart whose improvement is very unlikely.
/// @param z  (lowest - mean) / deviation
double log_improvement(double z) {
  constexpr double kTail = -6.0;
  const double log_density = -0.5 * z * z - 0.5 * std::log(2.0 * std::numbers::pi);
  // phi(z) + z Phi(z) -> phi(z) / z^2 for z -> -infinity.
  if (z < kTail) return log_density - 2.0 * std::log(-z);
  return std::log(std::exp(log_density) + 0.5 * z * std::erfc(-z / std::numbers::sqrt2));
}

double nearest_distance(const std::vector<Point>& points) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      nearest = std::min(nearest, (points[i] - points[j]).norm());
    }
  }
  return nearest;
}

/// A Latin hypercube (McKay, Beckman, Conover 1979) of the middles of its parts.
std::vector<Point> latin_points(Eigen::Index axes, std::size_t count, std::mt19937_64& random) {
  std::vector<Point> points(count, Point(axes));
  for (Eigen::Index axis = 0; axis < axes; ++axis) {
    const std::vector<std::size_t> parts = shuffled(count, random);
    for (std::size_t i = 0; i < count; ++i) {
      points[i](axis) = (static_cast<double>(parts[i]) + 0.5) / static_cast<double>(count);
    }
  }
  return points;
}

}  // namespace

PointSearch::PointSearch(std::vector<SearchAxis> axes, SearchMethod method, std::uint64_t seed)
    : axes_(std::move(axes)), method_(method), random_(seed) {
  if (method_ == SearchMethod::kModel) start_ = start_points();
}

Point PointSearch::snapped(Point point) const {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    double& at = point(static_cast<Eigen::Index>(i));
    at = std::clamp(at, 0.0, 1.0);
    if (axes_[i].values == 0) continue;
    const auto count = static_cast<double>(axes_[i].values);
    at = (std::min(std::floor(at * count), count - 1.0) + 0.5) / count;
  }
  return point;
}

bool PointSearch::is_known(const Point& point) const {
  constexpr double kSame = 1e-6;
  return std::any_of(points_.begin(), points_.end(), [&](const Point& known) {
    return (known - point).cwiseAbs().maxCoeff() < kSame;
  });
}

bool PointSearch::is_exhausted() const {
  double count = 1.0;
  for (const SearchAxis& axis : axes_) {
    if (axis.values == 0) return false;
    count *= static_cast<double>(axis.values);
  }
  return static_cast<double>(points_.size()) >= count;
}

Point PointSearch::random_point() {
  Point point(static_cast<Eigen::Index>(axes_.size()));
  for (double& at : point) at = unit_number(random_);
  return snapped(std::move(point));
}

Point PointSearch::unknown_point() {
  constexpr int kMostDraws = 100;
  Point point = random_point();
  for (int draw = 0; draw < kMostDraws && is_known(point); ++draw) point = random_point();
  if (!is_known(point)) return point;
  // Nearly all points of a grid are known: counts through them.
  std::vector<std::size_t> index(axes_.size());
  for (;;) {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      point(static_cast<Eigen::Index>(i)) =
          (static_cast<double>(index[i]) + 0.5) / static_cast<double>(axes_[i].values);
    }
    if (!is_known(point)) return point;
    for (std::size_t i = 0; i < axes_.size() && ++index[i] == axes_[i].values; ++i) index[i] = 0;
  }
}

std::vector<Point> PointSearch::start_points() {
  constexpr int kDraws = 50;
  const std::size_t count = std::max<std::size_t>(3, axes_.size());
  std::vector<Point> best;
  double best_distance = -1.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<Point> points =
        latin_points(static_cast<Eigen::Index>(axes_.size()), count, random_);
    const double distance = nearest_distance(points);
    if (distance <= best_distance) continue;
    best = std::move(points);
    best_distance = distance;
  }
  return best;
}

GaussianProcess PointSearch::model_of(std::size_t count, const std::vector<double>& values) const {
  Eigen::MatrixXd points(static_cast<Eigen::Index>(axes_.size()), static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i) points.col(static_cast<Eigen::Index>(i)) = points_[i];
  return GaussianProcess::fit(points,
                              Eigen::Map<const Eigen::VectorXd>(values.data(), points.cols()));
}

Point PointSearch::most_promising() const {
  constexpr int kEvaluationsPerAxis = 300;
  constexpr double kNoDeviation = 1e-12;
  GaussianProcess model = model_of(values_.size(), values_);
  const double lowest = *std::min_element(values_.begin(), values_.end());
  if (points_.size() > values_.size()) {
    std::vector<double> believed = values_;
    for (std::size_t i = values_.size(); i < points_.size(); ++i) {
      believed.push_back(model.predict(points_[i]).mean);
    }
    model = model_of(points_.size(), believed);
  }
  const BoxMinimum best = global_minimum(
      [&](const Point& point) {
        const auto [mean, deviation] = model.predict(snapped(point));
        const double certain = std::max(deviation, kNoDeviation);
        return -std::log(certain) - log_improvement((lowest - mean) / certain);
      },
      static_cast<Eigen::Index>(axes_.size()),
      kEvaluationsPerAxis * static_cast<int>(axes_.size()));
  return snapped(best.at);
}

std::vector<Point> PointSearch::next(std::size_t count) {
  assert(points_.size() == values_.size());
  while (points_.size() < values_.size() + count && !is_exhausted()) {
    Point point;
    if (!start_.empty()) {
      point = snapped(std::move(start_.back()));
      start_.pop_back();
    } else if (method_ == SearchMethod::kModel && !values_.empty()) {
      point = most_promising();
    } else {
      point = random_point();
    }
    if (is_known(point)) point = unknown_point();
    points_.push_back(std::move(point));
  }
  return {points_.begin() + static_cast<std::ptrdiff_t>(values_.size()), points_.end()};
}

void PointSearch::tell(const std::vector<double>& values) {
  assert(points_.size() == values_.size() + values.size());
  values_.insert(values_.end(), values.begin(), values.end());
}

}  // namespace overfly::server::experiments
