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
#include "server/views/video/video_encoders.hpp"

namespace overfly::server {

/// Width and height from a JPEG's frame header, and whether it is grey; empty if there is no
/// header.
struct JpegSize {
  int width_px = 0;
  int height_px = 0;
  bool grey = false;
};
[[nodiscard]] std::optional<JpegSize> jpeg_size(const std::vector<std::uint8_t>& jpeg);

/// Encodes as the request says: as JPEG, of which the last few are cached, so that two viewers of a
/// live camera need one encoding; or as video. Not thread-safe.
class PictureEncoder {
 public:
  [[nodiscard]] Result<Picture> encode(const StampedImage& image, const PictureRequest& request);
  /// An image of a quantity, drawn from a camera's image of the given size.
  [[nodiscard]] Result<Picture> encode(const StampedImage& image,
                                       const ColourScale& scale,
                                       const PinholeCamera& camera,
                                       const PictureRequest& request);
  /// A recorded JPEG; unchanged if it fits, unless bytes are to be saved.
  [[nodiscard]] Result<Picture> encode_file(const std::filesystem::path& file,
                                            std::int64_t frame,
                                            std::int64_t t_ns,
                                            const PictureRequest& request);
  /// Frees what is kept for a viewer that has gone.
  void forget(std::uint64_t viewer) { video_.forget(viewer); }

 private:
  struct Kept {
    std::shared_ptr<const Image> image;  ///< kept alive, so that its address is not reused
    int quality = 0;
    int max_width_px = 0;
    Picture picture;
  };
  [[nodiscard]] Result<Picture> encode_jpeg_picture(const StampedImage& image,
                                                    const PictureRequest& request);
  std::list<Kept> kept_;
  VideoEncoders video_;
};

}  // namespace overfly::server
