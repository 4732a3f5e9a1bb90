#include "terrain/raster/unwritten_blocks.hpp"

#include <algorithm>
#include <string>

namespace overfly::terrain {
namespace {

/// Reads the file's table of blocks, because GDAL 3.6's GetDataCoverageStatus reports written
/// strips as absent.
bool was_written(GDALRasterBand& band, int column, int row) {
  const std::string at = std::to_string(column) + "_" + std::to_string(row);
  return band.GetMetadataItem(("BLOCK_OFFSET_" + at).c_str(), "TIFF") != nullptr;
}

}  // namespace

Result<bool> has_unwritten_blocks(GDALRasterBand& band,
                                  const std::filesystem::path& file,
                                  const Cancelled& cancelled) {
  GDALDataset* dataset = band.GetDataset();
  GDALDriver* driver = dataset != nullptr ? dataset->GetDriver() : nullptr;
  if (driver == nullptr || std::string(driver->GetDescription()) != "GTiff") return false;
  int block_width = 0;
  int block_height = 0;
  band.GetBlockSize(&block_width, &block_height);
  const int columns = (band.GetXSize() + block_width - 1) / block_width;
  const int rows = (band.GetYSize() + block_height - 1) / block_height;
  int seen = 0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (++seen % kBlocksAtOnce == 0) {
        if (Status status = go_on(cancelled, file); !status) return status.error();
      }
      if (!was_written(band, column, row)) return true;
    }
  }
  return false;
}

void mask_unwritten_blocks(GDALRasterBand& band, int x, int y, Image& valid) {
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
