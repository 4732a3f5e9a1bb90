// Checksum of images and of stored bytes.
#pragma once

#include <cstdint>
#include <span>

#include "core/camera/image.hpp"

namespace overfly {

/// CRC-32 of the image's bytes, row by row, as in zlib and PNG. Used to check that several
/// estimators received the same frames.
[[nodiscard]] std::uint32_t crc32_of(const Image& image);
/// The same of any bytes.
[[nodiscard]] std::uint32_t crc32_of(std::span<const std::uint8_t> bytes);

}  // namespace overfly
