// Finds by how much the clock of a log's attitudes differs from that of its positions.
#pragma once

#include <atomic>

#include "core/result.hpp"
#include "flight/smoothing/motion_spline.hpp"

namespace overfly::flight::smoothing {

struct TimeOffset {
  /// To be added to the times of attitudes.
  double offset_s = 0.0;
  double sigma_s = 0.0;  ///< standard deviation, from the residuals of the fit
};

/// Largest offset that is looked for.
inline constexpr double kMaxTimeOffsetS = 2.0;

/// Method: the lift of a fixed-wing aircraft lies in its plane of symmetry, so the acceleration of
/// its path minus gravity has no part along the body's y axis (turn rate = g tan(bank) / V is the
/// special case of level flight). The offset is that at which this lateral part varies least, over
/// the part of the flight faster than 5 m/s. A constant part, as of a tilted mount, does not
/// matter. The standard deviation assumes one independent residual each second.
///
/// Sideslip that goes with the roll cannot be distinguished from an offset. It is the larger error:
/// 0.15 s in the state of a simulator, which has no offset. Differences between sources of one
/// flight are right within some 0.03 s.
/// @param attitude  body relative to north-east-down, by its own clock
/// Errors: kUnsupported if the flight has too few turns (a standard deviation above 0.2 s, or no
/// minimum within kMaxTimeOffsetS), or less than 30 s faster than 5 m/s; kCancelled.
[[nodiscard]] Result<TimeOffset> estimate_time_offset(const PositionSpline& position,
                                                      const RotationSpline& attitude,
                                                      const std::atomic<bool>* cancel);

}  // namespace overfly::flight::smoothing
