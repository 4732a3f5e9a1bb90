#include "server/files/jpeg.hpp"

#include <turbojpeg.h>

#include <memory>
#include <string>

namespace overfly::server {
namespace {

struct HandleDeleter {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, HandleDeleter>;

struct BufferDeleter {
  void operator()(unsigned char* buffer) const { tjFree(buffer); }
};

Error failure(const char* what, tjhandle handle) {
  return {ErrorCode::kInternal, std::string(what) + ": " + tjGetErrorStr2(handle)};
}

}  // namespace

Result<std::vector<std::uint8_t>> encode_jpeg(const Image& image, int quality) {
  if (quality < 1 || quality > 100) {
    return Error{ErrorCode::kInvalidArgument,
                 "quality = " + std::to_string(quality) + ": must be in [1, 100]"};
  }
  if (image.empty() || (image.channels != 1 && image.channels != 3)) {
    return Error{ErrorCode::kInvalidArgument,
                 "image of " + std::to_string(image.width_px) + " x " +
                     std::to_string(image.height_px) + " x " + std::to_string(image.channels) +
                     ": must have pixels and 1 or 3 channels"};
  }
  // One codec per thread, because creating it costs more than encoding a small image.
  thread_local const Handle handle{tjInitCompress()};
  if (!handle) return Error{ErrorCode::kInternal, "JPEG encoder: out of memory"};
  const bool grey = image.channels == 1;
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const int status = tjCompress2(handle.get(),
                                 image.data.data(),
                                 image.width_px,
                                 0,
                                 image.height_px,
                                 grey ? TJPF_GRAY : TJPF_RGB,
                                 &bytes,
                                 &size,
                                 grey ? TJSAMP_GRAY : TJSAMP_420,
                                 quality,
                                 0);
  const std::unique_ptr<unsigned char, BufferDeleter> owner{bytes};
  if (status != 0) return failure("JPEG encoder", handle.get());
  return std::vector<std::uint8_t>(bytes, bytes + size);
}

Status check_image_pixels(std::int64_t width_px, std::int64_t height_px, std::int64_t most_pixels) {
  if (width_px * height_px <= most_pixels) return {};
  return Error{ErrorCode::kInvalidArgument,
               std::to_string(width_px) + " x " + std::to_string(height_px) +
                   " px: must have at most " + std::to_string(most_pixels) + " pixels"};
}

Result<Image> decode_jpeg(std::span<const std::uint8_t> bytes, std::int64_t most_pixels) {
  thread_local const Handle handle{tjInitDecompress()};
  if (!handle) return Error{ErrorCode::kInternal, "JPEG decoder: out of memory"};
  int width = 0;
  int height = 0;
  int subsampling = 0;
  int colour_space = 0;
  if (tjDecompressHeader3(
          handle.get(), bytes.data(), bytes.size(), &width, &height, &subsampling, &colour_space) !=
      0) {
    return Error{ErrorCode::kUnreadable,
                 std::string("not a JPEG image: ") + tjGetErrorStr2(handle.get())};
  }
  constexpr auto kMost = static_cast<int>(kMostImageSidePx);
  if (width > kMost || height > kMost) {
    return Error{ErrorCode::kUnreadable,
                 "JPEG image of " + std::to_string(width) + " x " + std::to_string(height) +
                     " px: must be at most " + std::to_string(kMost) + " a side"};
  }
  if (Status status = check_image_pixels(width, height, most_pixels); !status) {
    return status.error();
  }
  const bool grey = colour_space == TJCS_GRAY;
  Image image(width, height, grey ? 1 : 3);
  if (tjDecompress2(handle.get(),
                    bytes.data(),
                    bytes.size(),
                    image.data.data(),
                    width,
                    0,
                    height,
                    grey ? TJPF_GRAY : TJPF_RGB,
                    0) != 0) {
    return Error{ErrorCode::kUnreadable,
                 std::string("damaged JPEG image: ") + tjGetErrorStr2(handle.get())};
  }
  return image;
}

}  // namespace overfly::server
