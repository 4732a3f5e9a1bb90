// Uniform knots of cubic B-splines and their basis functions.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace overfly::flight::smoothing {

/// Knots at begin_s + i * spacing_s. Segment i lies between knots i and i + 1 and depends on the
/// control points i to i + 3.
struct SplineKnots {
  double begin_s = 0.0;
  double spacing_s = 0.1;
  std::size_t segments = 1;

  [[nodiscard]] std::size_t control_points() const { return segments + 3; }
  [[nodiscard]] double end_s() const { return begin_s + spacing_s * static_cast<double>(segments); }

  /// The fewest segments that cover [begin_s, end_s]. @pre begin_s < end_s, spacing_s > 0
  [[nodiscard]] static SplineKnots covering(double begin_s, double end_s, double spacing_s) {
    const double segments = std::ceil((end_s - begin_s) / spacing_s);
    return {begin_s, spacing_s, static_cast<std::size_t>(std::max(1.0, segments))};
  }

  struct Place {
    std::size_t segment = 0;
    double u = 0.0;  ///< [0, 1] within the segment
  };
  /// Times outside of the knots count as the nearest end.
  [[nodiscard]] Place place(double t_s) const {
    const double at = std::clamp((t_s - begin_s) / spacing_s, 0.0, static_cast<double>(segments));
    const auto segment = std::min(static_cast<std::size_t>(at), segments - 1);
    return {segment, at - static_cast<double>(segment)};
  }
};

/// Weights of the four control points of a segment, and their derivatives by u.
[[nodiscard]] inline Eigen::Vector4d spline_weights(double u) {
  const double v = 1.0 - u;
  const double u2 = u * u;
  const double u3 = u2 * u;
  return Eigen::Vector4d(v * v * v, 3 * u3 - 6 * u2 + 4, -3 * u3 + 3 * u2 + 3 * u + 1, u3) / 6.0;
}
[[nodiscard]] inline Eigen::Vector4d spline_weights_1(double u) {
  const double v = 1.0 - u;
  return Eigen::Vector4d(-v * v, 3 * u * u - 4 * u, -3 * u * u + 2 * u + 1, u * u) / 2.0;
}
[[nodiscard]] inline Eigen::Vector4d spline_weights_2(double u) {
  return {1.0 - u, 3 * u - 2, 1 - 3 * u, u};
}

/// Cumulative weights of the second to fourth control point: sums of spline_weights from there on.
[[nodiscard]] inline Eigen::Vector3d cumulative_weights(double u) {
  const Eigen::Vector4d w = spline_weights(u);
  return {w[1] + w[2] + w[3], w[2] + w[3], w[3]};
}
[[nodiscard]] inline Eigen::Vector3d cumulative_weights_1(double u) {
  const Eigen::Vector4d w = spline_weights_1(u);
  return {w[1] + w[2] + w[3], w[2] + w[3], w[3]};
}

}  // namespace overfly::flight::smoothing
