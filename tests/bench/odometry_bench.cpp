// What one frame costs the feature estimator, on one core. Run: odometry_bench
// A banked flight over a synthetic ground is rendered beforehand and tracked once an iteration.
// `mean_per_detection` is the mean frame in units of one full corner detection of one image,
// measured in the same run, so that it says the same on another machine.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "odometry/feature/feature_odometry.hpp"
#include "odometry/feature/orb.hpp"
#include "tests/odometry/synthetic_flight.hpp"
#include "tests/odometry/test_frame.hpp"

namespace overfly::odometry {
namespace {

std::vector<VoFrame> make_frames() {
  const auto ground = testing::SyntheticGround::procedural(1, 2048, 0.5, 0.0);
  const auto camera =
      PinholeCamera::from_fov(1280, 960, rad_from_deg(84.872), FovAxis::kHorizontal).value();
  testing::SyntheticFlightOptions options;
  options.straight_s = 2.0;
  options.duration_s = 6.0;
  const std::vector<Pose> poses = testing::fly_s_turns(options);
  std::vector<VoFrame> frames;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    frames.push_back(testing::test_frame(i, camera, ground.render(camera, poses[i], 1.5, i + 1)));
  }
  return frames;
}

const std::vector<VoFrame>& frames() {
  static const std::vector<VoFrame> made = make_frames();
  return made;
}

double detection_ms() {
  const Image& image = *frames().front().image;
  const cv::Mat view(
      image.height_px, image.width_px, CV_8U, const_cast<std::uint8_t*>(image.data.data()));
  feature::OrbExtractor orb(feature::FeatureParameters{});
  const auto start = std::chrono::steady_clock::now();
  constexpr int kRepeats = 10;
  for (int i = 0; i < kRepeats; ++i) benchmark::DoNotOptimize(orb.detect(view));
  const std::chrono::duration<double, std::milli> passed = std::chrono::steady_clock::now() - start;
  return passed.count() / kRepeats;
}

void track_flight(benchmark::State& state) {
  frames();
  std::vector<double> total_ms;
  std::map<std::string, double> stages_ms;
  for (auto _ : state) {
    const auto odometry = feature::create_feature_odometry({}).value();
    for (const VoFrame& frame : frames()) {
      const VoEstimate estimate = odometry->track(frame).value();
      total_ms.push_back(estimate.timing_ms.at("total"));
      for (const auto& [stage, ms] : estimate.timing_ms) stages_ms[stage] += ms;
    }
  }
  std::sort(total_ms.begin(), total_ms.end());
  const auto count = static_cast<double>(total_ms.size());
  for (const auto& [stage, ms] : stages_ms) state.counters[stage + "_mean_ms"] = ms / count;
  state.counters["median_ms"] = total_ms[total_ms.size() / 2];
  state.counters["p95_ms"] = total_ms[total_ms.size() * 95 / 100];
  state.counters["mean_per_detection"] = stages_ms["total"] / count / detection_ms();
}
BENCHMARK(track_flight)->Unit(benchmark::kMillisecond)->Iterations(2);

}  // namespace
}  // namespace overfly::odometry

BENCHMARK_MAIN();
