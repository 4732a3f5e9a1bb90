// What one camera frame of the ray-caster costs, in units Q: the CPU time of one textured quad
// drawn by OpenGL in the same run. Run: raycast_bench [WORLD.json] [--benchmark_filter=...]
// Every figure is the median of the ratios of neighbouring calls, which a busy machine disturbs
// less than the ratio of medians.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <functional>
#include <memory>
#include <vector>

#include "renderer/probes/bench_probe.hpp"
#include "tests/bench/bench_ground.hpp"
#include "tests/bench/median.hpp"

namespace overfly::renderer {
namespace {

constexpr int kFrames = 60;

std::shared_ptr<const terrain::TileSource> tiles;

/// A gentle turn at 300 m: 25 m/s at 31 Hz, so that tiles come and go as in flight.
Pose pose_at(double frame) {
  const double t_s = frame / 31.0;
  const double east_m = 150.0 * std::sin(25.0 * t_s / 300.0);
  const double north_m = 150.0 * std::cos(25.0 * t_s / 300.0);
  const RollPitchYaw attitude{0.25 * std::sin(0.7 * t_s), 0.05, 25.0 * t_s / 300.0};
  return {R_world_body_from(attitude) * R_body_camera_nadir(),
          {east_m, north_m, tiles->ground_up_m(east_m, north_m) + 300.0}};
}

CameraRequest plain(int frame) {
  const PinholeCamera camera =
      PinholeCamera::from_fov(1280, 960, rad_from_deg(84.872), FovAxis::kHorizontal).value();
  return CameraRequest::still(camera, pose_at(4.0 * frame), 0, PixelFormat::kGrey8);
}

CameraRequest banked(int frame) {
  CameraRequest request = plain(frame);
  Pose pose = pose_at(4.0 * frame);
  pose.rotation = R_world_body_from({rad_from_deg(45.0), 0.0, 0.1 * frame}) * R_body_camera_nadir();
  request.T_world_camera = pose;
  return request;
}

CameraRequest moving(int frame, double exposure_s, double readout_s) {
  CameraRequest request = plain(frame);
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 20; ++i) {
    poses.push_back({i * 2'000'000LL, pose_at(4.0 * frame + 31.0 * (0.002 * i - 0.02))});
  }
  request.T_world_camera = CameraMotion::from_poses(poses).value();
  request.t_ns = 20'000'000;
  request.exposure_ns = static_cast<std::int64_t>(1e9 * exposure_s);
  request.readout_ns = static_cast<std::int64_t>(1e9 * readout_s);
  return request;
}

CameraRequest through_lens(int frame) {
  CameraRequest request = plain(frame);
  Distortion lens{DistortionModel::kRadtan, {-0.28, 0.08, 2e-4, -1e-4, 0.0}};
  request.camera = CameraModel(request.camera.pinhole(), lens);
  return request;
}

CameraRequest in_format(int frame, PixelFormat format) {
  CameraRequest request = plain(frame);
  request.format = format;
  return request;
}

CameraRequest reference(int frame) {
  CameraRequest request = plain(frame);
  request.quality = RenderQuality::kReference;
  return request;
}

CameraRequest hazy(int frame) {
  CameraRequest request = plain(frame);
  request.atmosphere.extinction_per_m = 1e-4;
  return request;
}

double seconds_of(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double seconds(clockid_t clock, const std::function<void()>& call) {
  const double before_s = seconds_of(clock);
  call();
  return seconds_of(clock) - before_s;
}

std::unique_ptr<Renderer> raycaster(int threads) {
  RendererOptions options;
  options.threads = threads;
  return create_raycast_renderer(tiles, options);
}

using MakeRequest = std::function<CameraRequest(int frame)>;

/// One thread's frame against the quad, by CPU time of the process.
void per_quad(benchmark::State& state, const MakeRequest& make) {
  const auto quad = QuadProbe::create();
  if (!quad.ok()) return state.SkipWithError(quad.error().message.c_str());
  const auto renderer = raycaster(1);
  const auto draw = [&](int frame) { (void)renderer->render_camera(make(frame)); };
  for (int i = 0; i < kFrames; ++i) draw(i);
  for (auto _ : state) {
    std::vector<double> ratios, frame_ms;
    for (int i = 0; i < kFrames; ++i) {
      const double quad_s = seconds(CLOCK_PROCESS_CPUTIME_ID, [&] { (void)(*quad)->draw(); });
      const double frame_s = seconds(CLOCK_PROCESS_CPUTIME_ID, [&] { draw(i); });
      ratios.push_back(frame_s / quad_s);
      frame_ms.push_back(1e3 * frame_s);
    }
    state.counters["per_quad"] = testing::median(ratios);
    state.counters["cpu_ms"] = testing::median(frame_ms);
  }
}

/// Wall time of one thread over that of several.
void speedup(benchmark::State& state) {
  const auto one = raycaster(1);
  const auto several = raycaster(static_cast<int>(state.range(0)));
  for (int i = 0; i < kFrames; ++i) {
    (void)one->render_camera(plain(i));
    (void)several->render_camera(plain(i));
  }
  for (auto _ : state) {
    std::vector<double> ratios;
    for (int i = 0; i < kFrames; ++i) {
      const auto wall = [&](Renderer& renderer) {
        return seconds(CLOCK_MONOTONIC, [&] { (void)renderer.render_camera(plain(i)); });
      };
      const double one_s = wall(*one);
      ratios.push_back(one_s / wall(*several));
    }
    state.counters["times_one"] = testing::median(ratios);
  }
}

void depth_per_quad(benchmark::State& state) {
  const auto quad = QuadProbe::create();
  if (!quad.ok()) return state.SkipWithError(quad.error().message.c_str());
  const auto renderer = raycaster(1);
  for (auto _ : state) {
    std::vector<double> ratios;
    for (int i = 0; i < kFrames; ++i) {
      const double quad_s = seconds(CLOCK_PROCESS_CPUTIME_ID, [&] { (void)(*quad)->draw(); });
      ratios.push_back(
          seconds(CLOCK_PROCESS_CPUTIME_ID, [&] { (void)renderer->render_depth(plain(i)); }) /
          quad_s);
    }
    state.counters["per_quad"] = testing::median(ratios);
  }
}

#define OVERFLY_PER_QUAD(name, ...)                           \
  BENCHMARK_CAPTURE(per_quad, name, MakeRequest(__VA_ARGS__)) \
      ->Iterations(1)                                         \
      ->Unit(benchmark::kMillisecond)

OVERFLY_PER_QUAD(trilinear, plain);
OVERFLY_PER_QUAD(banked_45_deg, banked);
OVERFLY_PER_QUAD(reference, reference);
OVERFLY_PER_QUAD(rgb, [](int i) { return in_format(i, PixelFormat::kRgb8); });
OVERFLY_PER_QUAD(grey_linear, [](int i) { return in_format(i, PixelFormat::kGreyLinear); });
OVERFLY_PER_QUAD(rgb_linear, [](int i) { return in_format(i, PixelFormat::kRgbLinear); });
OVERFLY_PER_QUAD(lens, through_lens);
OVERFLY_PER_QUAD(haze, hazy);
OVERFLY_PER_QUAD(rolling_shutter_20_ms, [](int i) { return moving(i, 0.0, 0.02); });
OVERFLY_PER_QUAD(exposure_2_ms, [](int i) { return moving(i, 0.002, 0.0); });
OVERFLY_PER_QUAD(exposure_10_ms, [](int i) { return moving(i, 0.01, 0.0); });
BENCHMARK(depth_per_quad)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(speedup)->Arg(2)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace overfly::renderer

int main(int argc, char** argv) {
  overfly::renderer::tiles = overfly::testing::bench_ground(argc, argv);
  if (overfly::renderer::tiles == nullptr) return 1;
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
