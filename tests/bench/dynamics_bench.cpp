// How many times faster than real time the flight model runs: each airframe at 400 Hz in banked
// flight through turbulence, on one core; and with its autopilot. Run: dynamics_bench
#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>

#include "core/measure/processor_time.hpp"
#include "flight/dynamics/flight_speed.hpp"
#include "tests/flight/autopilot/flights.hpp"
#include "tests/flight/dynamics/airframes.hpp"

namespace overfly::dynamics {
namespace {

void flight(benchmark::State& state, const std::string& name) {
  constexpr double kFlightS = 60.0;
  constexpr double kRateHz = 400.0;
  const Airframe airframe = testing::airframe(name);
  double best = 0.0;
  for (auto _ : state) {
    const auto speed = times_real_time(airframe, testing::cruise_m_s(name), kFlightS, kRateHz);
    if (!speed.ok()) return state.SkipWithError(speed.error().message.c_str());
    best = std::max(best, *speed);
  }
  state.counters["times_real_time"] = best;
}

/// The same with the autopilot at 100 Hz, circling in moderate turbulence.
void mission(benchmark::State& state, const std::string& name) {
  autopilot::MissionSetup setup = autopilot::testing::setup_of(name);
  setup.turbulence = TurbulenceLevel::kModerate;
  setup.duration_max_s = 60.0;
  setup.mission.items = {autopilot::testing::item_of(autopilot::MissionCommand::kLoiter,
                                                     autopilot::testing::waypoint(0, 200, 300))};
  double best = 0.0;
  for (auto _ : state) {
    const double before_s = thread_cpu_s();
    autopilot::testing::fly(setup, [](const autopilot::MissionFlight&) { return true; });
    best = std::max(best, setup.duration_max_s / (thread_cpu_s() - before_s));
  }
  state.counters["times_real_time"] = best;
}

BENCHMARK_CAPTURE(flight, aerosonde, "aerosonde")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(flight, foam_trainer, "foam_trainer")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(flight, piper_cub_third, "piper_cub_third")->Unit(benchmark::kMillisecond);

BENCHMARK_CAPTURE(mission, foam_trainer, "foam_trainer")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mission, piper_cub_third, "piper_cub_third")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace overfly::dynamics

BENCHMARK_MAIN();
