// JPEG encoding and decoding of frames.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/camera/image.hpp"
#include "core/result.hpp"

namespace overfly::server {

/// Limit for images from files, as of PinholeCamera.
inline constexpr std::uint32_t kMostImageSidePx = 16384;
inline constexpr std::int64_t kMostImagePixels = std::int64_t{kMostImageSidePx} * kMostImageSidePx;

/// @param quality  in [1, 100]. Grey stays grey; RGB is stored 4:2:0.
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_jpeg(const Image& image, int quality);
/// Errors: kUnreadable, also for a side above kMostImageSidePx; kInvalidArgument for more pixels
/// than `most_pixels`. Both are refused before anything of that size is allocated.
[[nodiscard]] Result<Image> decode_jpeg(std::span<const std::uint8_t> bytes,
                                        std::int64_t most_pixels = kMostImagePixels);
/// Errors: kInvalidArgument naming the size and the limit.
[[nodiscard]] Status check_image_pixels(std::int64_t width_px,
                                        std::int64_t height_px,
                                        std::int64_t most_pixels);

}  // namespace overfly::server
