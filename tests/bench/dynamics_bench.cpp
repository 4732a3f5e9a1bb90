// How many times faster than real time the flight model runs: each airframe at 400 Hz in banked
// flight through turbulence, on one core. Run: dynamics_bench
#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>

#include "flight/dynamics/flight_speed.hpp"
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

BENCHMARK_CAPTURE(flight, aerosonde, "aerosonde")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(flight, foam_trainer, "foam_trainer")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(flight, piper_cub_third, "piper_cub_third")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace overfly::dynamics

BENCHMARK_MAIN();
