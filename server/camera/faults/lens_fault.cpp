#include "server/camera/faults/lens_fault.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace overfly::server {
namespace {

constexpr float kFullScale = 255.0F;

float linear_from_srgb(float v) {
  return v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F);
}

float srgb_from_linear(float v) {
  return v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1.0F / 2.4F) - 0.055F;
}

std::uint8_t encoded(float radiance) {
  const float clipped = std::clamp(radiance, 0.0F, 1.0F);
  return static_cast<std::uint8_t>(std::lround(kFullScale * srgb_from_linear(clipped)));
}

}  // namespace

Image with_lens_faults(const Image& image, const std::vector<const FaultSpec*>& faults) {
  std::array<float, 256> linear{};
  for (std::size_t code = 0; code < linear.size(); ++code) {
    linear[code] = linear_from_srgb(static_cast<float>(code) / kFullScale);
  }
  RadianceImage radiance(image.width_px, image.height_px, image.channels);
  std::transform(
      image.data.begin(), image.data.end(), radiance.data.begin(), [&](std::uint8_t code) {
        return linear[code];
      });
  for (const FaultSpec* fault : faults) sensor::apply_fault(fault->image, radiance);
  Image changed(image.width_px, image.height_px, image.channels);
  std::transform(radiance.data.begin(), radiance.data.end(), changed.data.begin(), encoded);
  return changed;
}

}  // namespace overfly::server
