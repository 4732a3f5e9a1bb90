// What one image costs, in CPU time of the whole process (the software rasteriser's threads
// included). Run: renderer_bench [WORLD.json] [--benchmark_filter=...]
// `camera_per_quad` is the camera frame's cost in units Q, measured pair by pair in one run.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "renderer/probes/bench_probe.hpp"
#include "tests/bench/bench_ground.hpp"

namespace overfly::renderer {
namespace {

std::shared_ptr<const terrain::TileSource> tiles;

PinholeCamera camera() {
  return PinholeCamera::from_fov(1280, 960, rad_from_deg(84.872), FovAxis::kHorizontal).value();
}

/// A gentle turn at 300 m: 25 m/s at 31 Hz, so that tiles come and go as in flight.
Pose orbit_pose(int frame) {
  const double t_s = frame / 31.0;
  const double east_m = 150.0 * std::sin(25.0 * t_s / 300.0);
  const double north_m = 150.0 * std::cos(25.0 * t_s / 300.0);
  const RollPitchYaw attitude{0.25 * std::sin(0.7 * t_s), 0.05, 25.0 * t_s / 300.0};
  return {R_world_body_from(attitude) * R_body_camera_nadir(),
          {east_m, north_m, tiles->ground_up_m(east_m, north_m) + 300.0}};
}

std::unique_ptr<Renderer> renderer_or_skip(benchmark::State& state) {
  Result<std::unique_ptr<Renderer>> renderer = create_egl_renderer(tiles);
  if (renderer.ok()) return std::move(*renderer);
  state.SkipWithError(renderer.error().message.c_str());
  return nullptr;
}

void quad(benchmark::State& state) {
  const auto probe = QuadProbe::create();
  if (!probe.ok()) return state.SkipWithError(probe.error().message.c_str());
  for (auto _ : state) benchmark::DoNotOptimize((*probe)->draw().ok());
}

void camera_frame(benchmark::State& state, PixelFormat format) {
  const auto renderer = renderer_or_skip(state);
  if (renderer == nullptr) return;
  int frame = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        renderer->render_camera(camera(), orbit_pose(frame++), 0, format).ok());
  }
}

void depth(benchmark::State& state) {
  const auto renderer = renderer_or_skip(state);
  if (renderer == nullptr) return;
  int frame = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(renderer->render_depth(camera(), orbit_pose(frame++)).ok());
  }
}

void scene(benchmark::State& state) {
  const auto renderer = renderer_or_skip(state);
  if (renderer == nullptr) return;
  SceneContent content;
  content.ribbons.push_back({});
  for (int i = 0; i < state.range(0); ++i) {
    Pose body = orbit_pose(i);
    body.rotation = body.rotation * R_body_camera_nadir().conjugate();
    content.ribbons.back().T_world_body.push_back(body);
  }
  int frame = 0;
  for (auto _ : state) {
    SceneView view;
    view.T_world_camera = orbit_pose(frame++);
    view.T_world_camera.translation.z() += 200.0;
    benchmark::DoNotOptimize(renderer->render_scene(view, content).ok());
  }
}

void camera_per_quad(benchmark::State& state) {
  std::vector<Pose> poses;
  for (int i = 0; i < 60; ++i) poses.push_back(orbit_pose(4 * i));
  for (auto _ : state) {
    const auto costs = measure_render_costs(tiles, poses, 60);
    if (!costs.ok()) return state.SkipWithError(costs.error().message.c_str());
    state.counters["camera_per_quad"] = costs->camera_per_quad;
    state.counters["quad_cpu_ms"] = costs->quad.cpu_ms;
    state.counters["camera_cpu_ms"] = costs->camera_grey.cpu_ms;
    state.counters["rgb_cpu_ms"] = costs->camera_rgb.cpu_ms;
    state.counters["depth_cpu_ms"] = costs->depth.cpu_ms;
    state.counters["scene_cpu_ms"] = costs->scene.cpu_ms;
  }
}

BENCHMARK(camera_per_quad)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(quad)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(camera_frame, grey, PixelFormat::kGrey8)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(camera_frame, rgb, PixelFormat::kRgb8)
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(depth)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK(scene)->Arg(100)->Arg(10000)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace overfly::renderer

int main(int argc, char** argv) {
  overfly::renderer::tiles = overfly::testing::bench_ground(argc, argv);
  if (overfly::renderer::tiles == nullptr) return 1;
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
