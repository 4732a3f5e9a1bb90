// A smooth height over time above rough ground. Private to flight.
#pragma once

#include <functional>
#include <vector>

#include "core/result.hpp"

namespace overfly::flight {

struct HeightSample {
  double up_m = 0.0;
  double climb_m_s = 0.0;
  double climb_rate_m_s2 = 0.0;
};

struct HeightLimits {
  double knot_s = 1.6;  ///< knot spacing of the spline
  double climb_max_m_s = 3.5;
};

/// A uniform B-spline of degree five (four times continuously differentiable). Its control values
/// are means of the ground height with a triangular window of two knots: a low-pass filter without
/// lag. A ground wave of period P keeps the fraction sinc(knot / P)^8 of its amplitude: 88 % at 10
/// knots, 97 % at 20 knots. Below 2 knots, where waves are aliased, less than 6 % remains. If the
/// climb exceeds its limit, the knot spacing is increased until it does not.
class HeightProfile {
 public:
  /// @param ground_up_m  height of the ground under the aircraft at a time, also slightly outside
  /// [0, duration]
  /// Errors: kInvalidArgument for ground that is not finite, or too steep for any knot spacing.
  static Result<HeightProfile> above(const std::function<double(double t_s)>& ground_up_m,
                                     double height_agl_m,
                                     double duration_s,
                                     const HeightLimits& limits);

  [[nodiscard]] HeightSample at(double t_s) const;

 private:
  [[nodiscard]] double steepest_m_s(double duration_s) const;

  double knot_s_ = 1.0;
  std::vector<double> control_m_;  // the first is kMargin knots before t = 0
};

}  // namespace overfly::flight
