// Inside terrain only: a search through the blocks of a raster file without reading them.
#pragma once

#include <gdal_priv.h>

#include "terrain/cancelled.hpp"

namespace overfly::terrain {

/// Whether `test(column, row)` is true for a block of the band; asks for each block, row by row,
/// until it is.
/// @param test  returns Result<bool>; its error ends the search
/// Errors: kCancelled naming `file`; those of `test`.
template <typename Test>
[[nodiscard]] Result<bool> any_block(GDALRasterBand& band,
                                     const std::filesystem::path& file,
                                     const Cancelled& cancelled,
                                     const Test& test) {
  constexpr int kBlocksBetweenPolls = 4096;
  int block_width = 0;
  int block_height = 0;
  band.GetBlockSize(&block_width, &block_height);
  const int columns = (band.GetXSize() + block_width - 1) / block_width;
  const int rows = (band.GetYSize() + block_height - 1) / block_height;
  int seen = 0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (++seen % kBlocksBetweenPolls == 0) {
        if (Status status = go_on(cancelled, file); !status) return status.error();
      }
      const Result<bool> found = test(column, row);
      if (!found || *found) return found;
    }
  }
  return false;
}

}  // namespace overfly::terrain
