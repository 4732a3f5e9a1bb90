// Image files: PNG for images, GeoTIFF for depth.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/camera/image.hpp"
#include "core/result.hpp"

namespace overfly::terrain {

/// Writes 8-bit grey or RGB. The file appears whole or not at all, without side-car files.
/// Errors: kInvalidArgument for an empty image or other channels; kIo naming the file.
[[nodiscard]] Status write_png(const std::filesystem::path& file, const Image& image);

/// As above, with 16 bits per sample.
[[nodiscard]] Status write_png(const std::filesystem::path& file, const Image16& image);

/// Reads a 16-bit grey or RGB image.
/// @param most_side_px  limit of width and height
/// Errors: kNotFound; kUnreadable, also for samples of other types. A side above the limit and a
/// PGM or PPM file shorter than its samples are refused before anything of the image's size is
/// allocated.
[[nodiscard]] Result<Image16> read_png16(const std::filesystem::path& file,
                                         std::uint32_t most_side_px);

/// Reads any 8-bit image format of GDAL; palettes become RGB, alpha is dropped.
/// Parameters and errors: as read_png16.
[[nodiscard]] Result<Image> read_png(const std::filesystem::path& file, std::uint32_t most_side_px);

/// Writes depths [m] as a 32-bit float TIFF without georeference (the image is the camera's).
/// Sky (+infinity) is written as such. Errors: as write_png.
[[nodiscard]] Status write_geotiff_depth(const std::filesystem::path& file,
                                         const DepthImage& depth);

/// Writes 32- or 64-bit floats of one or three channels as a TIFF without georeference, pixel by
/// pixel; infinities and NaN are written as such. Errors: as write_png.
[[nodiscard]] Status write_tiff(const std::filesystem::path& file, const ImageBuffer<float>& image);
[[nodiscard]] Status write_tiff(const std::filesystem::path& file,
                                const ImageBuffer<double>& image);

}  // namespace overfly::terrain
