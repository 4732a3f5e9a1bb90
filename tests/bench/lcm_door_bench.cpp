// Images of 1280 x 960 to an estimator on LCM and its answers back: how long, and how many are lost
// to a small receive buffer. UDP multicast on this machine; the estimator copies the image and
// computes its CRC-32, no more.
#include <benchmark/benchmark.h>

#include <string>

#include "tests/vo_bridges/lcm/lcm_test_estimator.hpp"

namespace overfly {
namespace {

void fly_lcm(benchmark::State& state, const testing::LcmPair& pair) {
  VoFrame frame = testing::varied_frames(1, 1280, 960).front();
  double images = 0.0;
  double lost = 0.0;
  for (auto _ : state) {
    auto estimate = pair.door->track(frame);
    if (!estimate) return state.SkipWithError(estimate.error().message.c_str());
    ++images;
    lost += estimate->counters["images_lost"];
    ++frame.index;
    frame.t_ns += 32'258'065;
  }
  state.counters["lost_percent"] = 100.0 * lost / images;
}

void memory(benchmark::State& state) { fly_lcm(state, testing::make_memq_pair()); }

/// Argument: the estimator's receive buffer [bytes]; real time, so that nothing is sent again.
void multicast(benchmark::State& state) {
  if (const std::string reason = testing::multicast_missing(); !reason.empty()) {
    return state.SkipWithError(reason.c_str());
  }
  LcmEstimatorOptions options;
  options.url = testing::private_udp_url();
  options.lockstep = false;
  fly_lcm(state,
          testing::make_udp_pair(
              {}, options, options.url + "&recv_buf_size=" + std::to_string(state.range(0))));
}

BENCHMARK(memory)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(multicast)
    ->Arg(106496)  // the kernel doubles it: 208 KiB, the customary size
    ->Arg(1 << 20)
    ->Arg(2 << 20)
    ->Arg(4 << 20)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace overfly

BENCHMARK_MAIN();
