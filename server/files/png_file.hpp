// A fast PNG writer, so that writing a data set keeps up with rendering.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/camera/image.hpp"
#include "core/result.hpp"

namespace overfly::server {

/// Encodes grey, RGB or RGB with opacity, 8 or 16 bit, lossless. Every row uses the "up" filter and
/// the lowest compression level, which takes a twentieth of the processor time of libpng's level 6
/// (tests/bench/png_bench). The bytes depend only on the image and the libdeflate version.
/// @pre the image is not empty and has 1, 3 or 4 channels
[[nodiscard]] std::vector<std::uint8_t> encode_png(const Image& image);
[[nodiscard]] std::vector<std::uint8_t> encode_png(const Image16& image);

/// Encodes into a file, which appears whole or not at all.
/// Errors: kInvalidArgument for an empty image or other channels; kIo naming the file.
[[nodiscard]] Status write_png_file(const std::filesystem::path& file, const Image& image);
[[nodiscard]] Status write_png_file(const std::filesystem::path& file, const Image16& image);

}  // namespace overfly::server
