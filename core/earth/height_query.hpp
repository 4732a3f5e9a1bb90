// Interface to the ground's height, independent of its source.
#pragma once

#include <Eigen/Core>

namespace overfly {

/// The ground as a surface over the world frame's east-north plane.
/// Implementations are immutable after construction: calls are thread-safe.
class HeightQuery {
 public:
  virtual ~HeightQuery() = default;

  /// Up coordinate of the ground on the vertical line through (east, north), world frame [m].
  /// Beyond the edge of the elevation data the value at the edge continues.
  [[nodiscard]] virtual double ground_up_m(double east_m, double north_m) const = 0;
};

/// Flat ground in the tangent plane at a constant up coordinate [m].
class FlatGround final : public HeightQuery {
 public:
  explicit FlatGround(double up_m) : up_m_(up_m) {}
  [[nodiscard]] double ground_up_m(double /*east_m*/, double /*north_m*/) const override {
    return up_m_;
  }

 private:
  double up_m_;
};

}  // namespace overfly
