// Colours of the sky, the air and bare ground in each pixel format, against the standards.
#include "renderer/camera/air_light.hpp"

#include <gtest/gtest.h>

#include "renderer/raycast/paint/colours.hpp"

namespace overfly::renderer {
namespace {

CameraRequest request_in(PixelFormat format, double extinction_per_m) {
  CameraRequest request;
  request.format = format;
  request.atmosphere.extinction_per_m = extinction_per_m;
  request.atmosphere.airlight_rgb = {1.0F, 0.0F, 0.0F};
  return request;
}

TEST(AirLight, IsWeightedByTheStandardOfItsFormat) {
  // ITU-R BT.601 and BT.709.
  const double luma[] = {0.299, 0.587, 0.114}, luminance[] = {0.2126, 0.7152, 0.0722};
  for (int c = 0; c < 3; ++c) {
    std::array<float, 3> rgb{};
    rgb[c] = 1.0F;
    EXPECT_NEAR(light_in(PixelFormat::kGrey8, rgb)[0], luma[c], 0.002);
    EXPECT_NEAR(light_in(PixelFormat::kGreyLinear, rgb)[0], luminance[c], 1e-6);
    EXPECT_EQ(light_in(PixelFormat::kRgb8, rgb), rgb);
    EXPECT_EQ(light_in(PixelFormat::kRgbLinear, rgb), rgb);
  }
}

TEST(AirLight, IsLinearLightInTheLinearFormats) {
  // Published pairs of IEC 61966-2-1.
  const auto light = light_in(PixelFormat::kRgbLinear, {188.0F / 255, 118.0F / 255, 10.0F / 255});
  EXPECT_NEAR(light[0], 0.5029, 1e-4);
  EXPECT_NEAR(light[1], 0.1812, 1e-4);
  EXPECT_NEAR(light[2], 10.0 / 255.0 / 12.92, 1e-6);
  const auto grey = light_in(PixelFormat::kGreyLinear, {188.0F / 255, 188.0F / 255, 188.0F / 255});
  EXPECT_NEAR(grey[0], 0.5029, 1e-4);
}

TEST(AirLight, SkyIsTheAirsOnlyIfThereIsAir) {
  EXPECT_EQ(sky_light(request_in(PixelFormat::kRgb8, 1e-4)), (std::array{1.0F, 0.0F, 0.0F}));
  const auto clear = sky_light(request_in(PixelFormat::kRgb8, 0.0));
  EXPECT_LT(clear[0], clear[2]) << "a blue sky";
}

TEST(SceneColours, AreInTheUnitsOfTheFormat) {
  using raycast::SceneColours;
  const SceneColours bytes = SceneColours::of(request_in(PixelFormat::kRgb8, 1e-4));
  EXPECT_FLOAT_EQ(bytes.air[0], 255.0F);
  EXPECT_EQ(bytes.sky, bytes.air);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(bytes.nothing[c], terrain::kVoidRgb[c], 1e-4);
  const SceneColours grey = SceneColours::of(request_in(PixelFormat::kGrey8, 1e-4));
  EXPECT_NEAR(grey.air[0], 255.0 * 0.299, 0.5);
  EXPECT_NEAR(grey.nothing[0], 0.299 * 128 + 0.587 * 128 + 0.114 * 120, 0.1);
  const SceneColours linear = SceneColours::of(request_in(PixelFormat::kRgbLinear, 1e-4));
  EXPECT_FLOAT_EQ(linear.air[0], 1.0F);
  EXPECT_NEAR(linear.nothing[0], 0.2159, 1e-4);  // sRGB code 128
}

}  // namespace
}  // namespace overfly::renderer
