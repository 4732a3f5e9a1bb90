// Haze against Koschmieder's law, pixel by pixel, from the clear image and the range of the ground.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/renderer.hpp"
#include "tests/renderer/procedural_ground.hpp"
#include "tests/support/support.hpp"

namespace overfly::renderer {
namespace {

using overfly::testing::larger_error;

constexpr double kExtinctionPerM = 1e-3;
constexpr double kHeightM = 400.0;

/// IEC 61966-2-1.
double linear_from_srgb(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

std::shared_ptr<const terrain::TileSource> painted_plane() {
  testing::ProceduralGround::Options options;
  options.curved = false;
  options.texel_m = 1.0;
  options.paint = [](double east_m, double north_m) {
    return 110.0 + 60.0 * std::sin(0.02 * east_m) * std::cos(0.015 * north_m);
  };
  return std::make_shared<testing::ProceduralGround>(options);
}

CameraRequest tilted(PixelFormat format) {
  const PinholeCamera camera =
      PinholeCamera::from_fov(320, 240, rad_from_deg(70.0), FovAxis::kHorizontal).value();
  const Pose pose{R_world_body_from({rad_from_deg(35.0), 0.0, 0.4}) * R_body_camera_nadir(),
                  {0.0, 0.0, kHeightM}};
  return CameraRequest::still(camera, pose, 0, format);
}

/// Length of the ray to the plane z = 0.
double range_m(const CameraRequest& request, int x, int y) {
  const Eigen::Vector3d ray = request.camera.pinhole().ray({x, y});
  const Pose pose = request.T_world_camera.at(0);
  const double down = -(pose.rotation * ray).z();
  return kHeightM / down * ray.norm();
}

/// The air's light in a grey image; ITU-R BT.601 luma of the encoded colour for the 8-bit format,
/// BT.709 luminance for the linear one.
double airlight(const CameraRequest& request) {
  const auto& rgb = request.atmosphere.airlight_rgb;
  if (request.format == PixelFormat::kGrey8) {
    return 255.0 * (0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2]);
  }
  return 0.2126 * linear_from_srgb(rgb[0]) + 0.7152 * linear_from_srgb(rgb[1]) +
         0.0722 * linear_from_srgb(rgb[2]);
}

void expect_koschmieder(Renderer& renderer, PixelFormat format, double tolerance) {
  CameraRequest request = tilted(format);
  const auto clear = renderer.render_camera(request);
  ASSERT_TRUE(clear) << clear.error().message;
  request.atmosphere.extinction_per_m = kExtinctionPerM;
  const auto hazy = renderer.render_camera(request);
  ASSERT_TRUE(hazy) << hazy.error().message;
  const auto value = [&](const CameraFrame& frame, int x, int y) {
    return format == PixelFormat::kGrey8 ? frame.image.at(x, y) : frame.radiance.at(x, y);
  };
  double worst = 0.0;
  double longest_m = 0.0;
  for (int y = 3; y < 240; y += 7) {
    for (int x = 3; x < 320; x += 7) {
      const double d_m = range_m(request, x, y);
      const double passed = std::exp(-kExtinctionPerM * d_m);
      const double expected = value(*clear, x, y) * passed + airlight(request) * (1.0 - passed);
      worst = larger_error(worst, std::abs(value(*hazy, x, y) - expected));
      longest_m = std::max(longest_m, d_m);
    }
  }
  EXPECT_LT(worst, tolerance);
  EXPECT_GT(longest_m, 2.0 * kHeightM) << "near and far must both be seen";
}

TEST(Haze, FollowsKoschmiedersLawInTheRaycaster) {
  const auto renderer = create_raycast_renderer(painted_plane());
  expect_koschmieder(*renderer, PixelFormat::kGreyLinear, 1e-3);
  // Both images are rounded.
  expect_koschmieder(*renderer, PixelFormat::kGrey8, 1.3);
}

TEST(Haze, FollowsKoschmiedersLawInOpenGl) {
  const auto renderer = create_egl_renderer(painted_plane());
  if (!renderer) GTEST_SKIP() << renderer.error().message;
  expect_koschmieder(**renderer, PixelFormat::kGreyLinear, 1e-3);
  expect_koschmieder(**renderer, PixelFormat::kGrey8, 1.3);
}

}  // namespace
}  // namespace overfly::renderer
