// A camera's picture for a viewer, as JPEG and as VP8: time, bytes and difference from the image.
// The environment variable OVERFLY_BENCH_IMAGES names a folder of consecutive PNG images of a
// flight (overfly export --format euroc); without it a texture moves by 4 pixels from picture to
// picture.
#include <benchmark/benchmark.h>
#include <vpx/vp8dx.h>
#include <vpx/vpx_decoder.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "server/files/jpeg.hpp"
#include "server/views/video/live_encoder.hpp"
#include "tests/support/synthetic_world.hpp"

namespace {

using overfly::Image;

constexpr int kMostViews = 124;

std::vector<Image> moving_texture() {
  constexpr int kWidthPx = 1280;
  constexpr int kHeightPx = 960;
  constexpr int kStepPx = 4;
  const Image ground =
      overfly::testing::textured_image(kWidthPx, kHeightPx + kStepPx * kMostViews, 1);
  std::vector<Image> made;
  for (int i = 0; i < kMostViews; ++i) {
    Image& image = made.emplace_back(kWidthPx, kHeightPx, 1);
    const auto first = ground.data.begin() + static_cast<std::ptrdiff_t>(i) * kStepPx * kWidthPx;
    std::copy(first, first + static_cast<std::ptrdiff_t>(image.data.size()), image.data.begin());
  }
  return made;
}

std::vector<Image> images_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".png") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  if (files.size() > kMostViews) files.resize(kMostViews);
  std::vector<Image> images;
  for (const auto& file : files) {
    const cv::Mat read = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
    Image& image = images.emplace_back(read.cols, read.rows, 1);
    std::copy(read.begin<std::uint8_t>(), read.end<std::uint8_t>(), image.data.begin());
  }
  return images;
}

const std::vector<Image>& views() {
  static const std::vector<Image> instance = [] {
    const char* folder = std::getenv("OVERFLY_BENCH_IMAGES");
    return folder != nullptr ? images_in(folder) : moving_texture();
  }();
  return instance;
}

const Image& view(int k) { return views()[static_cast<std::size_t>(k) % views().size()]; }

double psnr_db(const std::uint8_t* a, int stride, const Image& b) {
  double squares = 0.0;
  for (int y = 0; y < b.height_px; ++y) {
    for (int x = 0; x < b.width_px; ++x) {
      const double difference = a[y * stride + x] - b.at(x, y, 0);
      squares += difference * difference;
    }
  }
  return 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(b.data.size()) / squares);
}

void report(benchmark::State& state, double bytes, double psnr_db) {
  state.counters["kB"] = benchmark::Counter(bytes / 1e3, benchmark::Counter::kAvgIterations);
  state.counters["psnr_db"] = benchmark::Counter(psnr_db, benchmark::Counter::kAvgIterations);
}

void Jpeg(benchmark::State& state) {
  double bytes = 0.0;
  double psnr = 0.0;
  int k = 0;
  (void)views();
  for (auto _ : state) {
    const Image& image = view(k++);
    const auto jpeg = overfly::server::encode_jpeg(image, static_cast<int>(state.range(0))).value();
    state.PauseTiming();
    bytes += static_cast<double>(jpeg.size());
    psnr += psnr_db(overfly::server::decode_jpeg(jpeg)->data.data(), image.width_px, image);
    state.ResumeTiming();
  }
  report(state, bytes, psnr);
}

void Vp8(benchmark::State& state) {
  const Image& first = view(0);
  auto encoder = overfly::server::LiveEncoder::open(first.width_px, first.height_px).value();
  vpx_codec_ctx_t decoder{};
  vpx_codec_dec_init(&decoder, vpx_codec_vp8_dx(), nullptr, 0);
  double bytes = 0.0;
  double psnr = 0.0;
  int k = 0;
  for (auto _ : state) {
    const Image& image = view(k++);
    const auto packet = encoder.encode(image, static_cast<int>(state.range(0)), false).value();
    state.PauseTiming();
    bytes += static_cast<double>(packet.bytes.size());
    const auto size = static_cast<unsigned>(packet.bytes.size());
    vpx_codec_decode(&decoder, packet.bytes.data(), size, nullptr, 0);
    vpx_codec_iter_t position = nullptr;
    const vpx_image_t* decoded = vpx_codec_get_frame(&decoder, &position);
    psnr += psnr_db(decoded->planes[VPX_PLANE_Y], decoded->stride[VPX_PLANE_Y], image);
    state.ResumeTiming();
  }
  vpx_codec_destroy(&decoder);
  report(state, bytes, psnr);
}

BENCHMARK(Jpeg)->Arg(60)->Arg(75)->Arg(90)->Unit(benchmark::kMillisecond)->Iterations(124);
BENCHMARK(Vp8)->Arg(60)->Arg(75)->Arg(90)->Unit(benchmark::kMillisecond)->Iterations(124);

}  // namespace

BENCHMARK_MAIN();
