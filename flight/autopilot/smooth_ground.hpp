// The ground's height without what an aircraft cannot follow.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <unordered_map>

#include "core/earth/height_query.hpp"

namespace overfly::autopilot {

/// A cubic B-spline over a square grid whose control values are means of nine heights around each
/// node (weights 1/4, 1/2, 1/4 at half a spacing): a low-pass filter without shift. A plane is
/// unchanged; of waves of period P along an axis the fraction sinc^4(s / P) cos^2(pi s / (2 P))
/// remains, s = spacing: 92 % at ten spacings, 20 % at two. Nodes are computed when they are
/// needed.
class SmoothGround {
 public:
  /// @param spacing_m  > 0
  SmoothGround(std::shared_ptr<const HeightQuery> ground, double spacing_m);

  /// World frame [m]; not a number where the ground has no height.
  [[nodiscard]] double up_m(const Eigen::Vector2d& position_m);

 private:
  [[nodiscard]] double node_m(std::int32_t column, std::int32_t row);

  std::shared_ptr<const HeightQuery> ground_;
  double spacing_m_;
  std::unordered_map<std::uint64_t, double> nodes_m_;
};

}  // namespace overfly::autopilot
