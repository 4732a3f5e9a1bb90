#include "flight/dynamics/actuators.hpp"

#include <algorithm>
#include <cmath>

namespace overfly::dynamics {
namespace {

double advance_one(double position, double command, const SurfaceLimits& limits, double dt_s) {
  if (std::isnan(command)) return position;
  const double error = std::clamp(command, limits.min_rad, limits.max_rad) - position;
  // Far from the command the rate is at its limit, until the rate of the lag is lower.
  const double near = limits.rate_rad_s * limits.lag_s;
  const double limited_s = std::max(0.0, (std::abs(error) - near) / limits.rate_rad_s);
  if (dt_s <= limited_s) return position + std::copysign(limits.rate_rad_s * dt_s, error);
  const double start = std::copysign(std::min(std::abs(error), near), error);
  return position + error - start * std::exp(-(dt_s - limited_s) / limits.lag_s);
}

SurfaceLimits as_surface(const ThrottleLimits& throttle) {
  return {0.0, 1.0, throttle.rate_1_s, throttle.lag_s};
}

}  // namespace

Controls advance(const Controls& positions,
                 const Controls& commands,
                 const Airframe& airframe,
                 double dt_s) {
  const auto moved = [&](double position, double command, const SurfaceLimits& limits) {
    return advance_one(position, command, limits, dt_s);
  };
  return {moved(positions.elevator_rad, commands.elevator_rad, airframe.elevator),
          moved(positions.aileron_rad, commands.aileron_rad, airframe.aileron),
          moved(positions.rudder_rad, commands.rudder_rad, airframe.rudder),
          moved(positions.throttle, commands.throttle, as_surface(airframe.throttle))};
}

Controls limited(const Controls& controls, const Airframe& airframe) {
  const auto clamped = [](double value, const SurfaceLimits& limits) {
    return std::isnan(value) ? 0.0 : std::clamp(value, limits.min_rad, limits.max_rad);
  };
  return {clamped(controls.elevator_rad, airframe.elevator),
          clamped(controls.aileron_rad, airframe.aileron),
          clamped(controls.rudder_rad, airframe.rudder),
          clamped(controls.throttle, as_surface(airframe.throttle))};
}

}  // namespace overfly::dynamics
