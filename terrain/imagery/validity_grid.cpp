#include "terrain/imagery/validity_grid.hpp"

#include <cmath>

namespace overfly::terrain {
namespace {

/// @param length_px  at least 1
int cells_over(int length_px, int cell_px) { return 1 + (length_px - 1) / cell_px; }

}  // namespace

Result<ValidityGrid> ValidityGrid::read(const ImageryRaster& raster, const Cancelled& cancelled) {
  ValidityGrid grid;
  grid.width_px_ = raster.width_px();
  grid.height_px_ = raster.height_px();
  constexpr double kCells = 2.0 * 1024 * 1024;
  while (static_cast<double>(grid.width_px_) / grid.cell_px_ * grid.height_px_ / grid.cell_px_ >
         kCells) {
    grid.cell_px_ *= 2;
  }
  const int size = grid.cell_px_;
  grid.columns_ = cells_over(grid.width_px_, size);
  grid.rows_ = cells_over(grid.height_px_, size);
  grid.cells_.resize(static_cast<std::size_t>(grid.columns_) * grid.rows_);
  // Parts of about 4 million texels, independent of the file's width.
  const int piece_columns = std::max(1, (1 << 22) / (size * size));
  for (int row = 0; row < grid.rows_; ++row) {
    for (int column = 0; column < grid.columns_; column += piece_columns) {
      if (Status status = go_on(cancelled, raster.file()); !status) return status.error();
      const int columns = std::min(piece_columns, grid.columns_ - column);
      const Status read = grid.read_cells(raster, column, row, columns);
      if (!read) return read.error();
    }
  }
  return grid;
}

Status ValidityGrid::read_cells(const ImageryRaster& raster, int column, int row, int columns) {
  const int left = column * cell_px_;
  const int top = row * cell_px_;
  const int height = std::min(cell_px_, height_px_ - top);
  auto piece = raster.read(0, left, top, std::min(columns * cell_px_, width_px_ - left), height);
  if (!piece) return piece.error();
  for (int i = 0; i < columns; ++i) {
    const int width = std::min(cell_px_, width_px_ - left - i * cell_px_);
    int count = 0;
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) count += piece->valid.at(i * cell_px_ + u, v) != 0;
    }
    const int area = width * height;
    cells_[static_cast<std::size_t>(row) * columns_ + column + i] = count == 0      ? Cell::kNone
                                                                    : count == area ? Cell::kAll
                                                                    : 2 * count >= area
                                                                        ? Cell::kMost
                                                                        : Cell::kSome;
  }
  return {};
}

std::vector<std::uint8_t> ValidityGrid::to_bytes() const {
  std::vector<std::uint8_t> bytes;
  for (const int number : {cell_px_, columns_, rows_, width_px_, height_px_}) {
    for (int i = 0; i < 4; ++i) {
      bytes.push_back(static_cast<std::uint8_t>(static_cast<unsigned>(number) >> (8 * i)));
    }
  }
  for (const Cell cell : cells_) bytes.push_back(static_cast<std::uint8_t>(cell));
  return bytes;
}

std::optional<ValidityGrid> ValidityGrid::from_bytes(const std::vector<std::uint8_t>& bytes,
                                                     int width_px,
                                                     int height_px) {
  constexpr std::size_t kHead = 20;
  if (bytes.size() < kHead) return std::nullopt;
  ValidityGrid grid;
  std::size_t at = 0;
  for (int* number :
       {&grid.cell_px_, &grid.columns_, &grid.rows_, &grid.width_px_, &grid.height_px_}) {
    unsigned value = 0;
    for (int i = 0; i < 4; ++i) value |= static_cast<unsigned>(bytes[at++]) << (8 * i);
    *number = static_cast<int>(value);
  }
  if (grid.cell_px_ < 1 || grid.width_px_ != width_px || grid.height_px_ != height_px ||
      grid.columns_ != cells_over(width_px, grid.cell_px_) ||
      grid.rows_ != cells_over(height_px, grid.cell_px_)) {
    return std::nullopt;
  }
  const std::size_t cells = static_cast<std::size_t>(grid.columns_) * grid.rows_;
  if (bytes.size() != kHead + cells) return std::nullopt;
  for (; at < bytes.size(); ++at) {
    if (bytes[at] > static_cast<std::uint8_t>(Cell::kAll)) return std::nullopt;
    grid.cells_.push_back(static_cast<Cell>(bytes[at]));
  }
  return grid;
}

bool ValidityGrid::any() const {
  return std::any_of(cells_.begin(), cells_.end(), [](Cell cell) { return cell != Cell::kNone; });
}

double ValidityGrid::void_share() const {
  double voids = 0.0;
  for (const Cell cell : cells_) voids += cell < Cell::kMost ? 1.0 : 0.0;
  return cells_.empty() ? 0.0 : voids / static_cast<double>(cells_.size());
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
