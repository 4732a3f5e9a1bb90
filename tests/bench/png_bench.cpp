// What a frame of 1280 x 960 costs as PNG: Overfly's fast compression compared with OpenCV's with
// libpng at its usual level 6. Run: png_bench
#include <benchmark/benchmark.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "renderer/renderer.hpp"
#include "server/files/png_file.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly {
namespace {

constexpr int kLibpngLevel = 6;

/// Painted hills 300 m below.
const Image& frame() {
  static const Image drawn = [] {
    const auto tiles = testing::natural_ground();
    const auto camera =
        PinholeCamera::from_fov(1280, 960, rad_from_deg(84.872), FovAxis::kHorizontal).value();
    const Pose pose{R_world_body_from({0.1, 0.05, 0.7}) * R_body_camera_nadir(),
                    {20.0, 30.0, tiles->ground_up_m(20.0, 30.0) + 300.0}};
    const auto renderer = renderer::create_raycast_renderer(tiles);
    return renderer->render_camera(camera, pose, 0, renderer::PixelFormat::kGrey8)->image;
  }();
  return drawn;
}

void fast(benchmark::State& state) {
  const Image& image = frame();
  std::size_t bytes = 0;
  for (auto _ : state) bytes = server::encode_png(image).size();
  state.counters["kB"] = static_cast<double>(bytes) * 1e-3;
}
BENCHMARK(fast)->Unit(benchmark::kMillisecond);

void libpng(benchmark::State& state) {
  const Image& image = frame();
  cv::Mat pixels(image.height_px, image.width_px, CV_8UC1);
  std::copy(image.data.begin(), image.data.end(), pixels.data);
  const std::vector<int> settings{cv::IMWRITE_PNG_COMPRESSION, kLibpngLevel};
  std::vector<unsigned char> file;
  for (auto _ : state) cv::imencode(".png", pixels, file, settings);
  state.counters["kB"] = static_cast<double>(file.size()) * 1e-3;
}
BENCHMARK(libpng)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace overfly

BENCHMARK_MAIN();
