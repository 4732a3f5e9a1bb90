#include "core/camera/halved_image.hpp"

#include <cstdint>

namespace overfly {
namespace {

std::shared_ptr<const Image> halved(const Image& image) {
  auto half = std::make_shared<Image>(image.width_px / 2, image.height_px / 2, image.channels);
  for (int y = 0; y < half->height_px; ++y) {
    for (int x = 0; x < half->width_px; ++x) {
      for (int c = 0; c < image.channels; ++c) {
        const int sum = image.at(2 * x, 2 * y, c) + image.at(2 * x + 1, 2 * y, c) +
                        image.at(2 * x, 2 * y + 1, c) + image.at(2 * x + 1, 2 * y + 1, c);
        half->at(x, y, c) = static_cast<std::uint8_t>((sum + 2) / 4);
      }
    }
  }
  return half;
}

}  // namespace

std::shared_ptr<const Image> halved_to_fit(std::shared_ptr<const Image> image, int max_width_px) {
  while (image->width_px > max_width_px && image->width_px > 1 && image->height_px > 1) {
    image = halved(*image);
  }
  return image;
}

}  // namespace overfly
