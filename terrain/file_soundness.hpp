// Inside terrain only: detects files that are truncated, in the wrong unit or wrongly located,
// without reading them completely.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "terrain/cancelled.hpp"
#include "terrain/gdal_dataset.hpp"

namespace overfly::terrain {

/// Checks a GeoTIFF's table of blocks, every file behind a virtual raster, and the last row of any
/// other file; GDAL's messages without an error are added to `warnings`.
/// Errors: kUnreadable for a truncated file, kNotFound for a missing source, kCancelled; each names
/// the file.
[[nodiscard]] Status check_whole(GDALDataset& dataset,
                                 const std::filesystem::path& file,
                                 const Cancelled& cancelled,
                                 std::vector<std::string>& warnings);

/// Rows to read in this order before the last one, for formats that decode all preceding rows to
/// find a row; each step is then short. Empty for other formats.
[[nodiscard]] std::vector<int> rows_on_the_way(GDALRasterBand& band);

/// Errors: kInvalidArgument for implausible pixel sizes: below 1 mm or above 100 km.
[[nodiscard]] Status check_pixel_size(const Georeference& place, const std::string& file);

/// A warning if the raster's centre lies far outside the area of use of its coordinate reference
/// system, a sign of coordinates in another unit or zone.
[[nodiscard]] std::optional<std::string> place_doubt(const Georeference& place,
                                                     int width_px,
                                                     int height_px,
                                                     const std::string& file);

}  // namespace overfly::terrain
