// How far the pictures are from what a pixel that gathers all its light would see: 16 x 16 samples
// of the same imagery.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "renderer/renderer.hpp"
#include "tests/renderer/image_distance.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

using overfly::testing::ProceduralGround;
using overfly::testing::psnr_db;

constexpr int kSamples = 16;  // along a pixel's side

/// A middle part of the paper's 1280 x 960 picture.
PinholeCamera part_of_camera() {
  PinholeCamera camera =
      PinholeCamera::from_fov(1280, 960, rad_from_deg(84.872), FovAxis::kHorizontal).value();
  camera.width_px = 200;
  camera.height_px = 150;
  camera.cx_px = 99.5;
  camera.cy_px = 74.5;
  return camera;
}

/// The same rays, each pixel divided.
PinholeCamera divided(const PinholeCamera& camera) {
  const auto place = [](double px) { return (px + 0.5) * kSamples - 0.5; };
  return {camera.width_px * kSamples,
          camera.height_px * kSamples,
          camera.fx_px * kSamples,
          camera.fy_px * kSamples,
          place(camera.cx_px),
          place(camera.cy_px)};
}

Image mean_of(const Image& fine, const PinholeCamera& camera) {
  Image image(camera.width_px, camera.height_px, 1);
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      int sum = 0;
      for (int j = 0; j < kSamples; ++j) {
        for (int i = 0; i < kSamples; ++i) sum += fine.at(x * kSamples + i, y * kSamples + j);
      }
      image.at(x, y) =
          static_cast<std::uint8_t>((sum + kSamples * kSamples / 2) / (kSamples * kSamples));
    }
  }
  return image;
}

class SamplingQuality : public ::testing::TestWithParam<const char*> {
 protected:
  static std::unique_ptr<Renderer> open(const std::shared_ptr<const terrain::TileSource>& tiles) {
    if (std::string(GetParam()) == "raycast") return create_raycast_renderer(tiles);
    auto egl = create_egl_renderer(tiles);
    return egl.ok() ? std::move(*egl) : nullptr;
  }
};

TEST_P(SamplingQuality, TrilinearIs44AndReference52DecibelsFromManySamples) {
  for (const double texel_m : {0.5, 0.25}) {
    ProceduralGround::Options options;
    options.texel_m = texel_m;
    options.cols = options.rows = 4;
    options.paint = overfly::testing::natural_paint;
    const auto tiles = std::make_shared<ProceduralGround>(options);
    const auto renderer = open(tiles);
    if (renderer == nullptr) GTEST_SKIP() << "no EGL here";
    const PinholeCamera camera = part_of_camera();
    const Pose pose{R_world_body_from({0.05, 0.03, 0.6}) * R_body_camera_nadir(),
                    {12.0, 7.0, 300.0}};
    const auto truth = create_raycast_renderer(tiles)->render_camera(
        divided(camera), pose, 0, PixelFormat::kGrey8);
    ASSERT_TRUE(truth.ok()) << truth.error().message;
    const Image many = mean_of(truth->image, camera);
    CameraRequest request = CameraRequest::still(camera, pose, 0, PixelFormat::kGrey8);
    const auto trilinear = renderer->render_camera(request);
    request.quality = RenderQuality::kReference;
    const auto reference = renderer->render_camera(request);
    ASSERT_TRUE(trilinear.ok() && reference.ok());
    const double trilinear_db = psnr_db(trilinear->image, many, 255.0);
    const double reference_db = psnr_db(reference->image, many, 255.0);
    std::printf("[ PSNR     ] %s, %.2f texels a pixel: trilinear %.1f dB, reference %.1f dB\n",
                GetParam(),
                trilinear->texels_per_pixel_median,
                trilinear_db,
                reference_db);
    EXPECT_GE(trilinear_db, 44.0);
    EXPECT_GE(reference_db, 52.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Renderers,
                         SamplingQuality,
                         ::testing::Values("egl", "raycast"),
                         [](const auto& suite) { return std::string(suite.param); });

}  // namespace
}  // namespace overfly::renderer
