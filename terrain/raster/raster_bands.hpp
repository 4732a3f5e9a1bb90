// Inside terrain only: selects the bands with a file's colours and converts them to 8 bit.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "terrain/cancelled.hpp"
#include "terrain/raster/area_average.hpp"
#include "terrain/raster/gdal_dataset.hpp"

namespace overfly::terrain {

struct RasterBands {
  std::array<int, 3> rgb{1, 1, 1};  ///< band numbers, equal for grey
  bool palette = false;
  std::vector<std::array<std::uint8_t, 4>> colours;  ///< of a palette; the fourth is alpha
  bool has_mask = false;
  /// Number of a band of transparency that GDAL does not relate to the colours: it does so only for
  /// files of two or four bands. 0 = none.
  int alpha = 0;
  /// Some blocks of the file were never written: they are void.
  bool unwritten = false;
  /// Value of void texels, given by the manifest instead of the file.
  std::optional<double> nodata;
  GDALDataType type = GDT_Byte;
  /// 8-bit value = (value - low) * 255 / (high - low), for bands that are not 8 bit. low > high if
  /// the file has no values to choose a range from.
  bool rescaled = false;
  double low = 0.0;
  double high = 255.0;
};

/// Selects the bands. The range of bands that are not 8 bit holds 99 % of a sample of all of them.
/// @param nodata  replaces the file's own mask
/// @param range  (low, high) to use instead
/// Errors: kUnreadable naming the file for complex samples; kInvalidArgument for a range of 8-bit
/// samples; kCancelled.
[[nodiscard]] Result<RasterBands> find_bands(GDALDataset& dataset,
                                             const std::string& file,
                                             const std::optional<double>& nodata,
                                             const std::optional<std::array<double, 2>>& range,
                                             const Cancelled& cancelled);

/// Reads a window that lies inside the dataset. Errors: kIo with GDAL's reason.
[[nodiscard]] Result<Patch> read_bands(GDALDataset& dataset,
                                       const RasterBands& bands,
                                       const std::string& file,
                                       int x,
                                       int y,
                                       int width,
                                       int height);

}  // namespace overfly::terrain
