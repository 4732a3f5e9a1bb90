// How fast the flight model runs on this machine.
#pragma once

#include "core/result.hpp"
#include "flight/dynamics/airframe.hpp"

namespace overfly::dynamics {

/// Flies an airframe in level turns through moderate turbulence, with commands that change at every
/// step, and measures the processor time of the calling thread.
/// @param airspeed_m_s  at which the airframe can fly level with 20 deg of bank
/// @param flight_s      simulated time [s], > 0
/// @param rate_hz       steps per second, at least 1 / kStepMaxS
/// @return simulated time over processor time
/// Errors: as trim.
[[nodiscard]] Result<double> times_real_time(const Airframe& airframe,
                                             double airspeed_m_s,
                                             double flight_s,
                                             double rate_hz);

}  // namespace overfly::dynamics
