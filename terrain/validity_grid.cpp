#include "terrain/validity_grid.hpp"

#include <cmath>

namespace overfly::terrain {

Result<ValidityGrid> ValidityGrid::read(const ImageryRaster& raster) {
  ValidityGrid grid;
  grid.width_px_ = raster.width_px();
  grid.height_px_ = raster.height_px();
  constexpr double kCells = 2.0 * 1024 * 1024;
  while (static_cast<double>(grid.width_px_) / grid.cell_px_ * grid.height_px_ / grid.cell_px_ >
         kCells) {
    grid.cell_px_ *= 2;
  }
  const int size = grid.cell_px_;
  grid.columns_ = (grid.width_px_ + size - 1) / size;
  grid.rows_ = (grid.height_px_ + size - 1) / size;
  grid.cells_.resize(static_cast<std::size_t>(grid.columns_) * grid.rows_);
  for (int row = 0; row < grid.rows_; ++row) {
    const int height = std::min(size, grid.height_px_ - row * size);
    auto strip = raster.read(0, 0, row * size, grid.width_px_, height);
    if (!strip) return strip.error();
    for (int column = 0; column < grid.columns_; ++column) {
      const int width = std::min(size, grid.width_px_ - column * size);
      int count = 0;
      for (int v = 0; v < height; ++v) {
        for (int u = 0; u < width; ++u) count += strip->valid.at(column * size + u, v) != 0;
      }
      const int area = width * height;
      grid.cells_[static_cast<std::size_t>(row) * grid.columns_ + column] =
          count == 0          ? Cell::kNone
          : count == area     ? Cell::kAll
          : 2 * count >= area ? Cell::kMost
                              : Cell::kSome;
    }
  }
  return grid;
}

bool ValidityGrid::valid_at(double px, double py) const {
  if (!(px >= 0.0 && py >= 0.0 && px < width_px_ && py < height_px_)) return false;
  return cell(static_cast<int>(px) / cell_px_, static_cast<int>(py) / cell_px_) >= Cell::kMost;
}

TileCoverage ValidityGrid::coverage(double left, double top, double right, double bottom) const {
  const bool inside = left >= 0.0 && top >= 0.0 && right <= width_px_ && bottom <= height_px_;
  const int first_column = std::max(0, static_cast<int>(std::floor(left / cell_px_)));
  const int first_row = std::max(0, static_cast<int>(std::floor(top / cell_px_)));
  const int last_column = std::min(columns_, static_cast<int>(std::ceil(right / cell_px_)));
  const int last_row = std::min(rows_, static_cast<int>(std::ceil(bottom / cell_px_)));
  bool any = false;
  bool all = inside;
  for (int row = first_row; row < last_row; ++row) {
    for (int column = first_column; column < last_column; ++column) {
      any = any || cell(column, row) != Cell::kNone;
      all = all && cell(column, row) == Cell::kAll;
    }
  }
  if (!any) return TileCoverage::kNone;
  return all ? TileCoverage::kFull : TileCoverage::kPartial;
}

}  // namespace overfly::terrain
