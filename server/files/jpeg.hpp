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

/// @param quality  in [1, 100]. Grey stays grey; RGB is stored 4:2:0.
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_jpeg(const Image& image, int quality);
/// Errors: kUnreadable, also for a side above kMostImageSidePx, before anything of that size is
/// allocated.
[[nodiscard]] Result<Image> decode_jpeg(std::span<const std::uint8_t> bytes);

}  // namespace overfly::server
