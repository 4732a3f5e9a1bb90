// A smooth height over time above a ground that is not smooth. Private to flight.
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
  double knot_s = 1.6;  ///< distance of the spline's knots
  double climb_max_m_s = 3.5;
};

/// A uniform B-spline of degree five (four times continuously differentiable) whose control values
/// are means of the ground, weighted by a triangle of two knots: a low-pass without lag. A wave of
/// the ground of period P keeps sinc(knot / P)^8 of its size: at 10 knots 88 %, at 20 knots 97 %;
/// below 2 knots, where waves are aliased, less than 6 %.
/// Where the climb would exceed its limit the knots are moved apart until it does not.
class HeightProfile {
 public:
  /// @param ground_up_m  ground under the aircraft at a time, also a little outside [0, duration]
  /// Errors: kInvalidArgument for ground that is not finite, or too steep whatever the knots.
  static Result<HeightProfile> above(const std::function<double(double t_s)>& ground_up_m,
                                     double height_agl_m,
                                     double duration_s,
                                     const HeightLimits& limits);

  [[nodiscard]] HeightSample at(double t_s) const;

 private:
  [[nodiscard]] double steepest_m_s(double duration_s) const;

  double knot_s_ = 1.0;
  std::vector<double> control_m_;  // the first stands kMargin knots before t = 0
};

}  // namespace overfly::flight
