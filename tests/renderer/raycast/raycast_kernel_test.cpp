// The ray-caster's vector code gives the plain code's bits, and threads change no image.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "renderer/raycast/paint/sample.hpp"
#include "renderer/raycast/raycast_renderer.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer::raycast {
namespace {

TilePixels noise_pixels(PixelFormat format) {
  std::mt19937 random(7);
  terrain::Tile tile{Image(terrain::kTileSide, terrain::kTileSide, 3),
                     Image(terrain::kTileSide, terrain::kTileSide, 1)};
  for (std::uint8_t& value : tile.rgb.data) value = static_cast<std::uint8_t>(random());
  for (std::uint8_t& value : tile.valid.data) value = 255;
  return tile_pixels_from(tile, format);
}

/// A block somewhere in the tile, or partly beyond it, at any level of detail.
TexelBlock random_block(std::mt19937& random) {
  const auto in = [&](double low, double high) {
    return static_cast<float>(std::uniform_real_distribution<double>(low, high)(random));
  };
  TexelBlock block;
  block.columns = std::uniform_int_distribution<int>(1, kBlockSide)(random);
  block.rows = std::uniform_int_distribution<int>(1, kBlockSide)(random);
  block.u0 = in(-20.0, terrain::kTileSide + 20.0);
  block.v0 = in(-20.0, terrain::kTileSide + 20.0);
  block.inverse_depth = {in(0.002, 0.01), in(-1e-5, 1e-5), in(-1e-5, 1e-5), in(-1e-7, 1e-7)};
  for (Bilinear4* numerator : {&block.numerator_u, &block.numerator_v}) {
    *numerator = {in(-0.1, 0.1), in(-0.02, 0.02), in(-0.02, 0.02), in(-1e-5, 1e-5)};
  }
  const float slope = in(0.0, 1.0) < 0.5F ? 0.0F : 0.05F;
  block.lod = {in(-2.0, 9.0), in(-slope, slope), in(-slope, slope), 0.0F};
  return block;
}

void sample(const SampleKernel& kernel,
            const TexelBlock& block,
            const PackedTile& tile,
            float* out) {
  SamplePlan plan;
  kernel.plan(block, tile, plan);
  kernel.read(plan, out);
}

TEST(RaycastKernel, VectorCodeGivesThePlainCodesBits) {
  if (&best_sample_kernel() == &plain_sample_kernel()) GTEST_SKIP() << "this machine has no AVX2";
  std::mt19937 random(1);
  for (const PixelFormat format : {PixelFormat::kGrey8,
                                   PixelFormat::kRgb8,
                                   PixelFormat::kGreyLinear,
                                   PixelFormat::kRgbLinear}) {
    const PackedTile tile = PackedTile::from(noise_pixels(format));
    for (int i = 0; i < 3000; ++i) {
      const TexelBlock block = random_block(random);
      std::array<float, std::size_t{3} * kBlockPixels> plain{}, fast{};
      sample(plain_sample_kernel(), block, tile, plain.data());
      sample(best_sample_kernel(), block, tile, fast.data());
      for (int plane = 0; plane < tile.planes; ++plane) {
        for (int row = 0; row < block.rows; ++row) {
          for (int column = 0; column < block.columns; ++column) {
            const int at = plane * kBlockPixels + row * kBlockSide + column;
            ASSERT_EQ(plain[at], fast[at]) << "block " << i << ", level " << block.lod[0]
                                           << ", pixel " << column << ' ' << row;
          }
        }
      }
    }
  }
}

/// A bilinear sample (OpenGL 4.5, section 8.14.3, clamped to the edge) in double precision.
/// @param u, v  texels of mip 0
template <typename T>
double bilinear_sample(const ImageBuffer<T>& level, int channel, double u, double v) {
  const double x =
      std::clamp(u * level.width_px / terrain::kTileSide - 0.5, 0.0, level.width_px - 1.0);
  const double y =
      std::clamp(v * level.height_px / terrain::kTileSide - 0.5, 0.0, level.height_px - 1.0);
  const int left = static_cast<int>(x), top = static_cast<int>(y);
  const int right = std::min(left + 1, level.width_px - 1);
  const int bottom = std::min(top + 1, level.height_px - 1);
  const double a = x - left, b = y - top;
  return (1 - b) * ((1 - a) * level.at(left, top, channel) + a * level.at(right, top, channel)) +
         b * ((1 - a) * level.at(left, bottom, channel) + a * level.at(right, bottom, channel));
}

template <typename T>
double trilinear_sample(
    const std::vector<ImageBuffer<T>>& levels, int channel, double u, double v, double lod) {
  const double clamped = std::clamp(lod, 0.0, kPackedMips - 1.0);
  const int fine = static_cast<int>(clamped);
  const int coarse = std::min(fine + 1, kPackedMips - 1);
  const double between = clamped - fine;
  return (1.0 - between) * bilinear_sample(levels[fine], channel, u, v) +
         between * bilinear_sample(levels[coarse], channel, u, v);
}

TEST(RaycastKernel, PlainCodeSamplesTrilinearlyAndClampsAtTheEdge) {
  std::mt19937 random(2);
  for (const PixelFormat format : {PixelFormat::kGrey8, PixelFormat::kRgbLinear}) {
    const TilePixels pixels = noise_pixels(format);
    const PackedTile tile = PackedTile::from(pixels);
    // Weights of 1/127 between rows of 8-bit noise; a float's place in texels of 16-bit noise.
    const double tolerance = is_linear(format) ? 40.0 : 255.0 * 0.5 / 127.0 + 0.05;
    for (int i = 0; i < 300; ++i) {
      const TexelBlock block = random_block(random);
      std::array<float, std::size_t{3} * kBlockPixels> plain{};
      sample(plain_sample_kernel(), block, tile, plain.data());
      for (int row = 0; row < block.rows; ++row) {
        for (int column = 0; column < block.columns; ++column) {
          const auto value = [&](const Bilinear4& f) {
            return double{f[0]} + f[1] * column + (double{f[2]} + f[3] * column) * row;
          };
          const double depth = 1.0 / value(block.inverse_depth);
          const double u = block.u0 + value(block.numerator_u) * depth;
          const double v = block.v0 + value(block.numerator_v) * depth;
          for (int plane = 0; plane < tile.planes; ++plane) {
            const double lod = value(block.lod);
            const double expected = is_linear(format)
                                        ? trilinear_sample(pixels.linear_levels, plane, u, v, lod)
                                        : trilinear_sample(pixels.levels, plane, u, v, lod);
            ASSERT_NEAR(
                plain[plane * kBlockPixels + row * kBlockSide + column], expected, tolerance)
                << "block " << i << ", level " << lod << ", texel " << u << ' ' << v;
          }
        }
      }
    }
  }
}

CameraRequest moving_request(PixelFormat format, RenderQuality quality) {
  const PinholeCamera camera =
      PinholeCamera::from_fov(320, 240, rad_from_deg(84.872), FovAxis::kHorizontal).value();
  const auto pose = [](double roll_rad, double east_m) {
    return Pose{R_world_body_from({roll_rad, 0.3, 0.8}) * R_body_camera_nadir(),
                {east_m, -300.0, 120.0}};
  };
  CameraRequest request;
  request.camera = CameraModel(camera, {DistortionModel::kRadtan, {-0.2, 0.05, 1e-3, -1e-3, 0.0}});
  request.T_world_camera =
      CameraMotion::from_poses({{0, pose(0.4, 300.0)}, {40'000'000, pose(0.5, 301.0)}}).value();
  request.t_ns = 20'000'000;
  request.readout_ns = 20'000'000;
  request.exposure_ns = 4'000'000;
  request.format = format;
  request.quality = quality;
  return request;
}

TEST(RaycastKernel, NeitherThreadsNorTheKernelChangeAFrame) {
  const auto tiles = overfly::testing::natural_ground();
  RaycastOptions plain_options;
  plain_options.tile_store = std::make_shared<TileStore>(tiles, TileStoreOptions{});
  plain_options.threads = 1;
  plain_options.kernel = &plain_sample_kernel();
  RaycastOptions many_options;
  many_options.tile_store = plain_options.tile_store;
  many_options.threads = 3;
  const auto plain = create_raycaster(tiles, plain_options);
  const auto many = create_raycaster(tiles, many_options);
  for (const CameraRequest& request :
       {moving_request(PixelFormat::kRgb8, RenderQuality::kTrilinear),
        moving_request(PixelFormat::kGreyLinear, RenderQuality::kReference)}) {
    const auto a = plain->render_camera(request);
    const auto b = many->render_camera(request);
    ASSERT_TRUE(a.ok() && b.ok());
    EXPECT_EQ(a->image.data, b->image.data);
    EXPECT_EQ(a->radiance.data, b->radiance.data);
    EXPECT_EQ(a->texels_per_pixel_median, b->texels_per_pixel_median);
    EXPECT_EQ(a->void_fraction, b->void_fraction);
  }
  const CameraRequest request = moving_request(PixelFormat::kGrey8, RenderQuality::kTrilinear);
  EXPECT_EQ(plain->render_depth(request)->data, many->render_depth(request)->data);
}

}  // namespace
}  // namespace overfly::renderer::raycast
