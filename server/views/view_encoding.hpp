// Encodes images as pictures for viewers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <list>
#include <memory>
#include <optional>
#include <utility>

#include "core/camera/camera.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/views/picture_request.hpp"

namespace overfly::server {

/// Width and height from a JPEG's frame header, and whether it is grey; empty if there is no
/// header.
struct JpegSize {
  int width_px = 0;
  int height_px = 0;
  bool grey = false;
};
[[nodiscard]] std::optional<JpegSize> jpeg_size(const std::vector<std::uint8_t>& jpeg);

/// Encodes, and caches the last few results, so that two viewers of a live camera need one
/// encoding. Not thread-safe.
class PictureEncoder {
 public:
  [[nodiscard]] Result<Picture> encode(const StampedImage& image, int quality, int max_width_px);
  /// An image of a quantity, drawn from a camera's image of the given size.
  [[nodiscard]] Result<Picture> encode(const StampedImage& image,
                                       const ColourScale& scale,
                                       const PinholeCamera& camera,
                                       int quality,
                                       int max_width_px);
  /// A recorded JPEG; unchanged if it fits.
  [[nodiscard]] Result<Picture> encode_file(const std::filesystem::path& file,
                                            std::int64_t frame,
                                            std::int64_t t_ns,
                                            int quality,
                                            int max_width_px);

 private:
  struct Kept {
    std::shared_ptr<const Image> image;  ///< kept alive, so that its address is not reused
    int quality = 0;
    int max_width_px = 0;
    Picture picture;
  };
  std::list<Kept> kept_;
};

}  // namespace overfly::server
