// Reads image files as 8-bit grey.
#pragma once

#include <filesystem>

#include "core/camera/image.hpp"
#include "core/result.hpp"

namespace overfly::server {

/// Reads PNG, JPEG, PGM or PPM; the first bytes decide the format. Colour is converted to grey as
/// for colour cameras. Alpha is dropped. Of 16-bit samples the upper 8 of
/// `sample_bits` are kept.
/// Errors: kNotFound; kUnreadable naming the file: another format, damaged, a side above
/// kMostImageSidePx (refused before anything of that size is allocated), or a sample that exceeds
/// `sample_bits`.
[[nodiscard]] Result<Image> read_grey_image(const std::filesystem::path& file,
                                            int sample_bits = 16);

/// True for names that end in .png, .jpg, .jpeg, .pgm or .ppm.
[[nodiscard]] bool is_image_name(const std::filesystem::path& file);

}  // namespace overfly::server
