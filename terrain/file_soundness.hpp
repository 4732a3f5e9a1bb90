// Inside terrain only: signs that a file is cut short, in the wrong unit, or somewhere else than it
// says, found without reading all of it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "terrain/cancelled.hpp"
#include "terrain/gdal_dataset.hpp"

namespace overfly::terrain {

/// Looks at a GeoTIFF's table of blocks, at every file behind a virtual raster, and at the last row
/// of anything else; what GDAL says without failing goes to `warnings`.
/// Errors: kUnreadable for a file that is cut short, kNotFound for a missing source, kCancelled;
/// each names it.
[[nodiscard]] Status check_whole(GDALDataset& dataset,
                                 const std::filesystem::path& file,
                                 const Cancelled& cancelled,
                                 std::vector<std::string>& warnings);

/// Rows to be visited in this order before the last one, where a format finds a row by decoding all
/// those above it: none takes long then. Empty for other formats.
[[nodiscard]] std::vector<int> rows_on_the_way(GDALRasterBand& band);

/// Errors: kInvalidArgument for pixels that no survey has: below 1 mm or above 100 km.
[[nodiscard]] Status check_pixel_size(const Georeference& place, const std::string& file);

/// A warning when the raster's middle lies far outside the area its coordinate reference system is
/// made for: a sign of coordinates in another unit or zone.
[[nodiscard]] std::optional<std::string> place_doubt(const Georeference& place,
                                                     int width_px,
                                                     int height_px,
                                                     const std::string& file);

}  // namespace overfly::terrain
