// Inside terrain only: where a masked image has texels, in cells small enough for a look-up and
// large enough to be kept in memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "terrain/cancelled.hpp"
#include "terrain/imagery/imagery_raster.hpp"

namespace overfly::terrain {

class ValidityGrid {
 public:
  /// Reads the mask once. Errors: kIo; kCancelled.
  static Result<ValidityGrid> read(const ImageryRaster& raster, const Cancelled& cancelled);

  /// Conversion to bytes and back; empty if they are not those of a grid over a raster of this
  /// size.
  [[nodiscard]] std::vector<std::uint8_t> to_bytes() const;
  static std::optional<ValidityGrid> from_bytes(const std::vector<std::uint8_t>& bytes,
                                                int width_px,
                                                int height_px);

  /// Whether there is any valid texel.
  [[nodiscard]] bool any() const;
  /// Fraction of the cells that are mostly void.
  [[nodiscard]] double void_share() const;
  /// Whether most of the cell around a file texel is valid; false outside the file.
  [[nodiscard]] bool valid_at(double px, double py) const;
  /// Coverage of a rectangle of file texels, cells counted whole.
  [[nodiscard]] TileCoverage coverage(double left, double top, double right, double bottom) const;

 private:
  enum class Cell : std::uint8_t { kNone, kSome, kMost, kAll };
  [[nodiscard]] Cell cell(int column, int row) const {
    return cells_[static_cast<std::size_t>(row) * columns_ + column];
  }

  Status read_cells(const ImageryRaster& raster, int column, int row, int columns);

  int cell_px_ = 1;
  int columns_ = 0;
  int rows_ = 0;
  int width_px_ = 0;
  int height_px_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace overfly::terrain
