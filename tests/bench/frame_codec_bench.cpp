// What a picture of 1280 x 960 costs in the frame cache, compared with drawing it: CPU time of
// rendering, encoding and decoding. Run: frame_codec_bench
#include <benchmark/benchmark.h>

#include <vector>

#include "renderer/renderer.hpp"
#include "server/frame_cache/frame_codec.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly {
namespace {

using renderer::PixelFormat;

/// Painted hills 300 m below.
renderer::CameraRequest request(PixelFormat format) {
  static const auto tiles = testing::natural_ground();
  const auto camera =
      PinholeCamera::from_fov(1280, 960, rad_from_deg(84.872), FovAxis::kHorizontal).value();
  const Pose pose{R_world_body_from({0.1, 0.05, 0.7}) * R_body_camera_nadir(),
                  {20.0, 30.0, tiles->ground_up_m(20.0, 30.0) + 300.0}};
  return renderer::CameraRequest::still(CameraModel(camera), pose, 0, format);
}

renderer::Renderer& one_thread() {
  static const std::unique_ptr<renderer::Renderer> made = [] {
    renderer::RendererOptions options;
    options.threads = 1;
    return renderer::create_raycast_renderer(testing::natural_ground(), options);
  }();
  return *made;
}

void render(benchmark::State& state, PixelFormat format) {
  const renderer::CameraRequest asked = request(format);
  for (auto _ : state) benchmark::DoNotOptimize(one_thread().render_camera(asked).ok());
}

void encode(benchmark::State& state, PixelFormat format) {
  const renderer::CameraFrame frame = one_thread().render_camera(request(format)).value();
  server::FrameCodec codec;
  std::size_t bytes = 0;
  for (auto _ : state) bytes = codec.encode(frame).size();
  state.counters["kB"] = static_cast<double>(bytes) * 1e-3;
}

void decode(benchmark::State& state, PixelFormat format) {
  const renderer::CameraRequest asked = request(format);
  server::FrameCodec codec;
  const std::span<const std::uint8_t> encoded =
      codec.encode(one_thread().render_camera(asked).value());
  const std::vector<std::uint8_t> bytes(encoded.begin(), encoded.end());
  for (auto _ : state) benchmark::DoNotOptimize(codec.decode(bytes, asked).ok());
}

#define OVERFLY_PICTURES(step)                                                             \
  BENCHMARK_CAPTURE(step, grey, PixelFormat::kGrey8)->Unit(benchmark::kMillisecond);       \
  BENCHMARK_CAPTURE(step, colour, PixelFormat::kRgb8)->Unit(benchmark::kMillisecond);      \
  BENCHMARK_CAPTURE(step, light, PixelFormat::kGreyLinear)->Unit(benchmark::kMillisecond); \
  BENCHMARK_CAPTURE(step, colour_light, PixelFormat::kRgbLinear)->Unit(benchmark::kMillisecond)

OVERFLY_PICTURES(render);
OVERFLY_PICTURES(encode);
OVERFLY_PICTURES(decode);

}  // namespace
}  // namespace overfly

BENCHMARK_MAIN();
