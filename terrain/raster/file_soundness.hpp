// Inside terrain only: detects files that are truncated, in the wrong unit or wrongly located,
// without reading them completely.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "terrain/cancelled.hpp"
#include "terrain/raster/gdal_dataset.hpp"

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

}  // namespace overfly::terrain
