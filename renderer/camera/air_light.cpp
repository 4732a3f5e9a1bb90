#include "renderer/camera/air_light.hpp"

#include <cmath>

namespace overfly::renderer {

namespace {

constexpr std::array<float, 3> kSkyRgb{0.72F, 0.80F, 0.88F};

/// IEC 61966-2-1:1999, eq. 5 and 6.
float linear(float encoded) {
  return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

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
      return {0.2126F * linear(r) + 0.7152F * linear(g) + 0.0722F * linear(b), 0.0F, 0.0F};
    case PixelFormat::kRgbLinear:
      break;
  }
  return {linear(r), linear(g), linear(b)};
}

std::array<float, 3> sky_light(const CameraRequest& request) {
  const Atmosphere& air = request.atmosphere;
  return light_in(request.format, air.extinction_per_m > 0.0 ? air.airlight_rgb : kSkyRgb);
}

}  // namespace overfly::renderer
