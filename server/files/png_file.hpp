// PNG files, fast: a data set is written at the rate at which its images are drawn.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/image.hpp"
#include "core/result.hpp"

namespace overfly::engine {

/// Encodes grey or RGB, 8 or 16 bit. Lossless; every row is filtered with "up" and compressed at
/// the lowest level: a twentieth of the processor time of libpng's level 6 (tests/bench/png_bench).
/// The bytes depend on the image and the libdeflate version alone.
/// @pre the image is not empty and has 1 or 3 channels
[[nodiscard]] std::vector<std::uint8_t> encode_png(const Image& image);
[[nodiscard]] std::vector<std::uint8_t> encode_png(const Image16& image);

/// The same into a file, which appears whole or not at all.
/// Errors: kInvalidArgument for an empty image or other channels; kIo naming the file.
[[nodiscard]] Status write_png_file(const std::filesystem::path& file, const Image& image);
[[nodiscard]] Status write_png_file(const std::filesystem::path& file, const Image16& image);

}  // namespace overfly::engine
