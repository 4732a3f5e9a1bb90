#include "terrain/raster/unwritten_blocks.hpp"

#include <algorithm>
#include <string>

#include "terrain/raster/block_search.hpp"

namespace overfly::terrain {
namespace {

/// Reads the file's table of blocks, because GDAL 3.6's GetDataCoverageStatus reports written
/// strips as absent.
bool was_written(GDALRasterBand& band, int column, int row) {
  const std::string at = std::to_string(column) + "_" + std::to_string(row);
  return band.GetMetadataItem(("BLOCK_OFFSET_" + at).c_str(), "TIFF") != nullptr;
}

/// GDAL shows a compressed file of one long strip as rows, for which there is no table of blocks.
bool has_table_of_blocks(GDALRasterBand& band) {
  const int status = band.GetDataCoverageStatus(0, 0, 1, 1, 0, nullptr);
  return (status & GDAL_DATA_COVERAGE_STATUS_UNIMPLEMENTED) == 0;
}

}  // namespace

Result<bool> has_unwritten_blocks(GDALRasterBand& band,
                                  const std::filesystem::path& file,
                                  const Cancelled& cancelled) {
  GDALDataset* dataset = band.GetDataset();
  GDALDriver* driver = dataset != nullptr ? dataset->GetDriver() : nullptr;
  if (driver == nullptr || std::string(driver->GetDescription()) != "GTiff") return false;
  if (!has_table_of_blocks(band)) return false;
  return any_block(band, file, cancelled, [&](int column, int row) -> Result<bool> {
    return !was_written(band, column, row);
  });
}

void mask_unwritten_blocks(GDALRasterBand& band, int x, int y, Image& valid) {
  if (!has_table_of_blocks(band)) return;
  int block_width = 0;
  int block_height = 0;
  band.GetBlockSize(&block_width, &block_height);
  const int right = x + valid.width_px;
  const int bottom = y + valid.height_px;
  for (int row = y / block_height; row * block_height < bottom; ++row) {
    for (int column = x / block_width; column * block_width < right; ++column) {
      if (was_written(band, column, row)) continue;
      const int left = std::max(x, column * block_width);
      const int width = std::min(right, (column + 1) * block_width) - left;
      const int end = std::min(bottom, (row + 1) * block_height);
      for (int v = std::max(y, row * block_height); v < end; ++v) {
        std::fill_n(&valid.at(left - x, v - y), width, std::uint8_t{0});
      }
    }
  }
}

}  // namespace overfly::terrain
