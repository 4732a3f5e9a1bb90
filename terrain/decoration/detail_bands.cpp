#include "terrain/decoration/detail_bands.hpp"

#include <cmath>
#include <limits>

namespace overfly::terrain {
namespace {

constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

/// Weights of the blocks before, at and after that of an even texel: a triangle of half width 3
/// texels around the texel. Odd texels use the mirrored weights.
constexpr float kWeights[3] = {1.5F / 4.5F, 2.5F / 4.5F, 0.5F / 4.5F};

/// A texel's weighted mean over the surrounding blocks; blocks without value are omitted.
float contrast_at(const ImageBuffer<float>& strength, int x, int y) {
  float sum = 0.0F;
  float total = 0.0F;
  for (int j = -1; j <= 1; ++j) {
    const float row_weight = kWeights[(y % 2 == 0) ? j + 1 : 1 - j];
    for (int i = -1; i <= 1; ++i) {
      const float value = strength.at(x / 2 + i, y / 2 + j);
      if (std::isnan(value)) continue;
      const float weight = row_weight * kWeights[(x % 2 == 0) ? i + 1 : 1 - i];
      sum += weight * value;
      total += weight;
    }
  }
  return total > 0.0F ? sum / total : 0.0F;
}

}  // namespace

ImageBuffer<float> luma_of(const Patch& patch) {
  ImageBuffer<float> luma(patch.rgb.width_px, patch.rgb.height_px, 1);
  const std::uint8_t* rgb = patch.rgb.data.data();
  for (std::size_t i = 0; i < luma.data.size(); ++i, rgb += 3) {
    luma.data[i] =
        patch.valid.data[i] == 0 ? kNoValue : 0.299F * rgb[0] + 0.587F * rgb[1] + 0.114F * rgb[2];
  }
  return luma;
}

ImageBuffer<float> block_means(const ImageBuffer<float>& image) {
  ImageBuffer<float> means(image.width_px / 2, image.height_px / 2, 1);
  for (int y = 0; y < means.height_px; ++y) {
    for (int x = 0; x < means.width_px; ++x) {
      means.at(x, y) = 0.25F * (image.at(2 * x, 2 * y) + image.at(2 * x + 1, 2 * y) +
                                image.at(2 * x, 2 * y + 1) + image.at(2 * x + 1, 2 * y + 1));
    }
  }
  return means;
}

ImageBuffer<float> block_details(const ImageBuffer<float>& image, const ImageBuffer<float>& means) {
  ImageBuffer<float> details(means.width_px, means.height_px, 3, kNoValue);
  for (int y = 1; y + 1 < means.height_px; ++y) {
    for (int x = 1; x + 1 < means.width_px; ++x) {
      const float a = image.at(2 * x, 2 * y);
      const float b = image.at(2 * x + 1, 2 * y);
      const float c = image.at(2 * x, 2 * y + 1);
      const float d = image.at(2 * x + 1, 2 * y + 1);
      const float across =
          0.25F * (b + d - a - c) - 0.125F * (means.at(x + 1, y) - means.at(x - 1, y));
      const float down =
          0.25F * (c + d - a - b) - 0.125F * (means.at(x, y + 1) - means.at(x, y - 1));
      const float diagonal =
          0.25F * (a + d - b - c) - (means.at(x - 1, y - 1) + means.at(x + 1, y + 1) -
                                     means.at(x + 1, y - 1) - means.at(x - 1, y + 1)) /
                                        64.0F;
      if (std::isnan(across + down + diagonal)) continue;  // one of the texels is void
      details.at(x, y, 0) = across;
      details.at(x, y, 1) = down;
      details.at(x, y, 2) = diagonal;
    }
  }
  return details;
}

ImageBuffer<float> local_contrast(const ImageBuffer<float>& details) {
  ImageBuffer<float> strength(details.width_px, details.height_px, 1);
  for (std::size_t i = 0; i < strength.data.size(); ++i) {
    strength.data[i] = 0.5F * (std::abs(details.data[3 * i]) + std::abs(details.data[3 * i + 1]));
  }
  ImageBuffer<float> contrast(2 * details.width_px, 2 * details.height_px, 1);
  constexpr int kRim = 4;
  for (int y = kRim; y < contrast.height_px - kRim; ++y) {
    for (int x = kRim; x < contrast.width_px - kRim; ++x) {
      contrast.at(x, y) = contrast_at(strength, x, y);
    }
  }
  return contrast;
}

}  // namespace overfly::terrain
