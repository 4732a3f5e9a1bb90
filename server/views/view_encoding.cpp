#include "server/views/view_encoding.hpp"

#include <algorithm>

#include "core/camera/halved_image.hpp"
#include "core/outside/file_text.hpp"
#include "server/files/jpeg.hpp"

namespace overfly::server {
namespace {

constexpr std::size_t kMaxKept = 4;

/// True for the markers SOF0 to SOF15 that begin a frame (not DHT, JPG, DAC).
bool opens_frame(std::uint8_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

/// All but its coding.
Picture picture_of(const StampedImage& image, const Image& fitting) {
  Picture picture;
  picture.frame = image.frame;
  picture.t_ns = image.t_ns;
  picture.width_px = fitting.width_px;
  picture.height_px = fitting.height_px;
  picture.full_width_px = image.image->width_px;
  picture.full_height_px = image.image->height_px;
  picture.grey = fitting.channels == 1;
  return picture;
}

}  // namespace

std::optional<JpegSize> jpeg_size(const std::vector<std::uint8_t>& jpeg) {
  const auto word = [&](std::size_t at) { return jpeg[at] * 256 + jpeg[at + 1]; };
  std::size_t at = 2;  // after the start-of-image marker
  // Segments (ISO/IEC 10918-1, B.1.1.4): FF, marker, length (its own two bytes included), data.
  while (at + 10 <= jpeg.size() && jpeg[at] == 0xFF) {
    const std::uint8_t marker = jpeg[at + 1];
    if (opens_frame(marker)) return JpegSize{word(at + 7), word(at + 5), jpeg[at + 9] == 1};
    at += 2 + static_cast<std::size_t>(word(at + 2));
  }
  return std::nullopt;
}

Result<Picture> PictureEncoder::encode_jpeg_picture(const StampedImage& image,
                                                    const PictureRequest& request) {
  const auto known = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) {
    return kept.image == image.image && kept.quality == request.quality &&
           kept.max_width_px == request.max_width_px;
  });
  if (known != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, known);
    return kept_.front().picture;
  }
  const auto fitting = halved_to_fit(image.image, request.max_width_px);
  auto jpeg = encode_jpeg(*fitting, request.quality);
  if (!jpeg) return jpeg.error();
  Picture picture = picture_of(image, *fitting);
  picture.bytes = std::make_shared<const std::vector<std::uint8_t>>(std::move(*jpeg));
  kept_.push_front({image.image, request.quality, request.max_width_px, picture});
  if (kept_.size() > kMaxKept) kept_.pop_back();
  return picture;
}

Result<Picture> PictureEncoder::encode(const StampedImage& image, const PictureRequest& request) {
  if (!request.video) return encode_jpeg_picture(image, request);
  const auto fitting = halved_to_fit(image.image, request.max_width_px);
  auto packet = video_.encode(*request.video, *fitting, request.quality);
  if (!packet) return packet.error();
  if (!*packet) return encode_jpeg_picture(image, request);
  Picture picture = picture_of(image, *fitting);
  picture.coding = PictureCoding::kVp8;
  picture.key = (*packet)->key;
  picture.bytes = std::make_shared<const std::vector<std::uint8_t>>(std::move((*packet)->bytes));
  return picture;
}

Result<Picture> PictureEncoder::encode(const StampedImage& image,
                                       const ColourScale& scale,
                                       const PinholeCamera& camera,
                                       const PictureRequest& request) {
  Result<Picture> picture = encode(image, request);
  if (!picture) return picture;
  picture->full_width_px = camera.width_px;
  picture->full_height_px = camera.height_px;
  picture->scale = scale;
  return picture;
}

Result<Picture> PictureEncoder::encode_file(const std::filesystem::path& file,
                                            std::int64_t frame,
                                            std::int64_t t_ns,
                                            const PictureRequest& request) {
  constexpr std::uint64_t kMaxBytes = std::uint64_t{256} << 20U;
  auto bytes = read_file_bytes(file, kMaxBytes);
  if (!bytes) return bytes.error();
  const auto size = jpeg_size(*bytes);
  if (size && size->width_px <= request.max_width_px && !request.sparing) {
    Picture picture;
    picture.frame = frame;
    picture.t_ns = t_ns;
    picture.width_px = picture.full_width_px = size->width_px;
    picture.height_px = picture.full_height_px = size->height_px;
    picture.grey = size->grey;
    picture.bytes = std::make_shared<const std::vector<std::uint8_t>>(std::move(*bytes));
    return picture;
  }
  auto image = decode_jpeg(*bytes);
  if (!image) return image.error().in(file.string());
  return encode({frame, t_ns, std::make_shared<const Image>(std::move(*image))}, request);
}

}  // namespace overfly::server
