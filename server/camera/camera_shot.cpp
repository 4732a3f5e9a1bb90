#include "server/camera/camera_shot.hpp"

namespace overfly::server {

Image grey_of(const Image& image) {
  if (image.channels == 1) return image;
  Image grey(image.width_px, image.height_px, 1);
  for (std::size_t i = 0; i < grey.data.size(); ++i) {
    const std::uint8_t* rgb = &image.data[3 * i];
    grey.data[i] =
        static_cast<std::uint8_t>((299 * rgb[0] + 587 * rgb[1] + 114 * rgb[2] + 500) / 1000);
  }
  return grey;
}

}  // namespace overfly::server
