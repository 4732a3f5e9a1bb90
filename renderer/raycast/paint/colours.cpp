#include "renderer/raycast/paint/colours.hpp"

#include "renderer/camera/air_light.hpp"

namespace overfly::renderer::raycast {

namespace {

Colour in_grey_levels(PixelFormat format, Colour light) {
  if (is_linear(format)) return light;
  for (float& value : light) value *= 255.0F;
  return light;
}

}  // namespace

SceneColours SceneColours::of(const CameraRequest& request) {
  const PixelFormat format = request.format;
  std::array<float, 3> nothing_rgb{};
  for (std::size_t c = 0; c < 3; ++c) {
    nothing_rgb[c] = static_cast<float>(terrain::kVoidRgb[c]) / 255.0F;
  }
  SceneColours colours;
  colours.sky = in_grey_levels(format, sky_light(request));
  colours.nothing = in_grey_levels(format, light_in(format, nothing_rgb));
  colours.air = in_grey_levels(format, light_in(format, request.atmosphere.airlight_rgb));
  return colours;
}

}  // namespace overfly::renderer::raycast
