// Reads image files as 8-bit grey.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "server/files/jpeg.hpp"

namespace overfly::server {

/// Reads PNG, JPEG, PGM or PPM; the first bytes decide the format. Colour is converted to grey as
/// for colour cameras. Alpha is dropped. Of 16-bit samples the upper 8 of
/// `sample_bits` are kept.
/// @param most_pixels  more are refused
/// Errors: kNotFound; kUnreadable naming the file: another format, damaged, a side above
/// kMostImageSidePx, or a sample that exceeds `sample_bits`; kInvalidArgument for too many pixels.
/// Sizes are refused before anything of that size is allocated; pixels of PGM and PPM files, whose
/// bytes bound them, are counted afterwards.
[[nodiscard]] Result<Image> read_grey_image(const std::filesystem::path& file,
                                            int sample_bits = 16,
                                            std::int64_t most_pixels = kMostImagePixels);

/// True for names that end in .png, .jpg, .jpeg, .pgm or .ppm.
[[nodiscard]] bool is_image_name(const std::filesystem::path& file);

}  // namespace overfly::server
