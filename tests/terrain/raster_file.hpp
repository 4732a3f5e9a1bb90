// Rasters of any GDAL format, right or wrong, as tests want them.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace overfly::testing {

struct RasterFile {
  std::string driver = "GTiff";
  std::string type = "Byte";  ///< as GDAL names it: "Byte", "Int16", "Float32"
  int width_px = 64;
  int height_px = 64;
  int bands = 1;
  std::string crs = "EPSG:32616";  ///< empty = none
  /// GDAL's affine transform; empty = none.
  std::optional<std::array<double, 6>> transform{{583000.0, 2.0, 0.0, 4357000.0, 0.0, -2.0}};
  int alpha_band = 0;  ///< transparency; bands 1 to 3 are then red, green and blue. 0 = none
  std::string unit;    ///< of the values
  std::optional<double> nodata;
  std::function<double(int x, int y, int band)> value;  ///< empty = a texture in [0, 255]
  std::vector<std::string> options;                     ///< of the driver: "QUALITY=100"
};

/// Throws std::runtime_error with GDAL's reason.
void write_raster(const std::filesystem::path& file, const RasterFile& raster);

/// Values of one band at whole pixels, read only by GDAL.
[[nodiscard]] std::vector<double> read_band(const std::filesystem::path& file, int band = 1);

}  // namespace overfly::testing
