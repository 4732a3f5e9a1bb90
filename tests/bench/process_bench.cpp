// What the process door costs for one frame of 1280 x 960: handing it over, the CRC of both sides,
// the answer. The estimator answers immediately. For comparison: one copy of the image, and its
// CRC.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "core/measure/crc32.hpp"
#include "core/time.hpp"
#include "vo_bridges/process/process_estimator.hpp"

namespace overfly {
namespace {

std::vector<std::shared_ptr<const Image>> images() {
  std::vector<std::shared_ptr<const Image>> made;
  for (int i = 0; i < 4; ++i) {
    Image image(1280, 960, 1);
    for (std::size_t at = 0; at < image.data.size(); ++at) {
      image.data[at] =
          static_cast<std::uint8_t>((at * 31 + at / 1280 * 7) >> static_cast<unsigned>(i));
    }
    made.push_back(std::make_shared<const Image>(std::move(image)));
  }
  return made;
}

void fly_process(benchmark::State& state, const std::string& behaviour, const std::string& listen) {
  ProcessEstimatorOptions options;
  options.command = {OVERFLY_SCRIPTED_ESTIMATOR, behaviour};
  options.listen = listen;
  const auto estimator = create_process_estimator(options).value();
  const auto frames = images();
  VoFrame frame;
  frame.intrinsics = PinholeCamera::from_fov(1280, 960, 1.48, FovAxis::kHorizontal).value();
  frame.index = -1;
  for (auto _ : state) {
    ++frame.index;
    frame.t_ns = frame_time_ns(frame.index, FrameRate{});
    frame.image = frames[static_cast<std::size_t>(frame.index) % frames.size()];
    const Result<VoEstimate> estimate = estimator->track(frame);
    if (!estimate) {
      state.SkipWithError(estimate.error().message.c_str());
      break;
    }
  }
}

void copy_image(benchmark::State& state) {
  const auto frames = images();
  std::vector<std::uint8_t> copy(frames[0]->data.size());
  std::size_t i = 0;
  for (auto _ : state) {
    const Image& image = *frames[++i % frames.size()];
    std::copy(image.data.begin(), image.data.end(), copy.begin());
    benchmark::DoNotOptimize(copy.data());
    benchmark::ClobberMemory();
  }
}

void crc_of_image(benchmark::State& state) {
  const auto frames = images();
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(crc32_of(*frames[++i % frames.size()]));
}

BENCHMARK(copy_image)->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(crc_of_image)->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK_CAPTURE(fly_process, shared_memory, "good", "")
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(fly_process, unix_socket, "by_socket", "")
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(fly_process, tcp, "good", "tcp:127.0.0.1:0")
    ->Unit(benchmark::kMicrosecond)
    ->UseRealTime();

}  // namespace
}  // namespace overfly

BENCHMARK_MAIN();
