#include "renderer/tile_pixels.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace overfly::renderer {

namespace {

Image halved(const Image& image) {
  Image half(std::max(image.width_px / 2, 1), std::max(image.height_px / 2, 1), image.channels);
  const int dx = image.width_px > 1 ? 1 : 0;
  const int dy = image.height_px > 1 ? 1 : 0;
  for (int y = 0; y < half.height_px; ++y) {
    for (int x = 0; x < half.width_px; ++x) {
      for (int c = 0; c < image.channels; ++c) {
        const int sum = image.at(2 * x, 2 * y, c) + image.at(2 * x + dx, 2 * y, c) +
                        image.at(2 * x, 2 * y + dy, c) + image.at(2 * x + dx, 2 * y + dy, c);
        half.at(x, y, c) = static_cast<std::uint8_t>((sum + 2) / 4);
      }
    }
  }
  return half;
}

}  // namespace

Image grey_from_rgb(const Image& rgb) {
  Image grey(rgb.width_px, rgb.height_px, 1);
  for (std::size_t i = 0; i < grey.data.size(); ++i) {
    const std::uint8_t* p = &rgb.data[3 * i];
    grey.data[i] = static_cast<std::uint8_t>((77 * p[0] + 150 * p[1] + 29 * p[2] + 128) / 256);
  }
  return grey;
}

Image with_alpha(const Image& rgb, const Image& alpha) {
  Image rgba(rgb.width_px, rgb.height_px, 4);
  for (std::size_t i = 0; i < alpha.data.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) rgba.data[4 * i + c] = rgb.data[3 * i + c];
    rgba.data[4 * i + 3] = alpha.data[i];
  }
  return rgba;
}

std::vector<Image> mip_chain(Image level_0) {
  std::vector<Image> levels;
  levels.push_back(std::move(level_0));
  while (levels.back().width_px > 1 || levels.back().height_px > 1) {
    levels.push_back(halved(levels.back()));
  }
  return levels;
}

}  // namespace overfly::renderer
