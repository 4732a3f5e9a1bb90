// Image files as 8-bit grey.
#pragma once

#include <filesystem>

#include "core/image.hpp"
#include "core/result.hpp"

namespace overfly::engine {

/// Reads PNG, JPEG, PGM or PPM, told by the first bytes. Colour becomes grey as the engine makes it
/// of colour cameras; alpha is dropped; of 16-bit samples the upper 8 of `sample_bits` are kept.
/// Errors: kNotFound; kUnreadable naming the file: another format, damaged, a sample beyond
/// `sample_bits`.
[[nodiscard]] Result<Image> read_grey_image(const std::filesystem::path& file,
                                            int sample_bits = 16);

/// True for names that end as the formats above do (.png, .jpg, .jpeg, .pgm, .ppm).
[[nodiscard]] bool is_image_name(const std::filesystem::path& file);

}  // namespace overfly::engine
