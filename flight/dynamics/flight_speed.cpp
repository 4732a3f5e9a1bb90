#include "flight/dynamics/flight_speed.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/measure/processor_time.hpp"
#include "core/motion/pose.hpp"
#include "flight/dynamics/aircraft.hpp"
#include "flight/dynamics/trim.hpp"

namespace overfly::dynamics {

Result<double> times_real_time(const Airframe& airframe,
                               double airspeed_m_s,
                               double flight_s,
                               double rate_hz) {
  AircraftSetup setup;
  setup.airframe = airframe;
  setup.turbulence = TurbulenceLevel::kModerate;
  TrimRequest request;
  request.airspeed_m_s = airspeed_m_s;
  request.bank_rad = rad_from_deg(20.0);
  request.up_m = 300.0;
  const Result<Trim> turn = trim(airframe, setup.environment, request);
  if (!turn) return turn.error();
  Result<Aircraft> aircraft =
      Aircraft::create(setup, turn->state({0.0, 0.0, request.up_m}, 0.0), turn->controls);
  if (!aircraft) return aircraft.error();

  const double dt_s = 1.0 / rate_hz;
  const auto steps = static_cast<std::int64_t>(std::ceil(flight_s * rate_hz));
  const double before_s = thread_cpu_s();
  for (std::int64_t i = 0; i < steps; ++i) {
    Controls commands = turn->controls;
    commands.aileron_rad += 0.01 * std::sin(0.01 * static_cast<double>(i));
    if (Status status = aircraft->step(commands, dt_s); !status) return status.error();
  }
  const double used_s = std::max(1e-9, thread_cpu_s() - before_s);
  return static_cast<double>(steps) * dt_s / used_s;
}

}  // namespace overfly::dynamics
