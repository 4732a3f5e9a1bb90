#include "renderer/camera/air_light.hpp"

#include "renderer/tiles/srgb.hpp"

namespace overfly::renderer {

namespace {

constexpr std::array<float, 3> kSkyRgb{0.72F, 0.80F, 0.88F};

}  // namespace

std::array<float, 3> light_in(PixelFormat format, const std::array<float, 3>& encoded_rgb) {
  const auto& [r, g, b] = encoded_rgb;
  switch (format) {
    case PixelFormat::kGrey8:
      // ITU-R BT.601, as tile_pixels.hpp.
      return {(77.0F * r + 150.0F * g + 29.0F * b) / 256.0F, 0.0F, 0.0F};
    case PixelFormat::kRgb8:
      return encoded_rgb;
    case PixelFormat::kGreyLinear:
      // ITU-R BT.709, as tile_pixels.hpp.
      return {0.2126F * light_from_srgb(r) + 0.7152F * light_from_srgb(g) +
                  0.0722F * light_from_srgb(b),
              0.0F,
              0.0F};
    case PixelFormat::kRgbLinear:
      break;
  }
  return {light_from_srgb(r), light_from_srgb(g), light_from_srgb(b)};
}

std::array<float, 3> sky_light(const CameraRequest& request) {
  const Atmosphere& air = request.atmosphere;
  return light_in(request.format, air.extinction_per_m > 0.0 ? air.airlight_rgb : kSkyRgb);
}

}  // namespace overfly::renderer
