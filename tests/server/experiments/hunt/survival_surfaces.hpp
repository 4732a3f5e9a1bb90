// Survival margins as functions of several axes, each with a small region in which flights fail.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "server/experiments/drawn_numbers.hpp"

namespace overfly::server::experiments {

struct Surface {
  std::string name;
  std::size_t axes = 0;
  /// Margin at coordinates in [0, 1]; negative where the flight fails.
  std::function<double(const Eigen::VectorXd&)> margin;
};

/// Scatter of a flight's margin that no model can know: the same at equal points, in
/// [-amplitude, amplitude].
inline double scatter(const Eigen::VectorXd& point, double amplitude) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < point.size(); ++i) {
    sum += point(i) * (7919.0 + 104729.0 * static_cast<double>(i));
  }
  return amplitude * std::sin(sum);
}

/// Failure where everything is at its worst together: fast roll, low flight, long exposure.
inline Surface corner_surface() {
  return {"corner", 3, [](const Eigen::VectorXd& x) {
            const double burden = 0.9 * x(0) + 0.7 * (1.0 - x(1)) + 0.5 * x(2);
            return 0.5 * (1.74 - burden) + scatter(x, 0.02);
          }};
}

/// Failure in a pocket inside the limits, whose place differs from seed to seed. Far from it the
/// margin is flat.
inline Surface pocket_surface(std::uint64_t seed) {
  std::mt19937_64 random(1000 + seed);
  Eigen::Vector3d centre;
  for (double& at : centre) at = 0.2 + 0.6 * unit_number(random);
  return {"pocket", 3, [centre](const Eigen::VectorXd& x) {
            const double square = (x - centre).squaredNorm();
            return 0.6 - 0.75 * std::exp(-0.5 * square / (0.27 * 0.27)) + scatter(x, 0.02);
          }};
}

/// Failure beyond a curved border: the ground moves too fast through the image (speed over height).
/// Two more axes have no effect. Failed flights are far below zero, and easy ones saturate.
inline Surface border_surface() {
  return {"border", 4, [](const Eigen::VectorXd& x) {
            const double flow = (10.0 + 20.0 * x(0)) / (50.0 + 350.0 * x(1));
            const double margin = std::min(0.8, 1.0 - flow / 0.38);
            return margin < 0.0 ? margin - 0.4 : margin + scatter(x, 0.02);
          }};
}

/// Share of the limits in which flights fail, by 100 000 points.
inline double failing_share(const Surface& surface) {
  constexpr int kPoints = 100'000;
  std::mt19937_64 random(5);
  int failing = 0;
  Eigen::VectorXd point(static_cast<Eigen::Index>(surface.axes));
  for (int i = 0; i < kPoints; ++i) {
    for (double& at : point) at = unit_number(random);
    failing += surface.margin(point) < 0.0 ? 1 : 0;
  }
  return static_cast<double>(failing) / kPoints;
}

}  // namespace overfly::server::experiments
