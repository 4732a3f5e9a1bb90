// Control surfaces and throttle: limits, rate limits and lag.
#pragma once

#include "flight/dynamics/airframe.hpp"

namespace overfly::dynamics {

/// Commands or positions of the controls. Signs: Airframe.
struct Controls {
  double elevator_rad = 0.0;
  double aileron_rad = 0.0;
  double rudder_rad = 0.0;
  double throttle = 0.0;  ///< [0, 1], share of the battery's voltage
};

/// The positions after a time with constant commands.
///
/// A position x follows its command c by dx/dt = (c - x) / lag, limited to the rate and to the
/// range; solved exactly. A command outside the range counts as the nearer limit, and one that is
/// not a number as the present position.
/// @pre dt_s >= 0
[[nodiscard]] Controls advance(const Controls& positions,
                               const Controls& commands,
                               const Airframe& airframe,
                               double dt_s);

/// The same controls within the airframe's limits.
[[nodiscard]] Controls limited(const Controls& controls, const Airframe& airframe);

}  // namespace overfly::dynamics
