#include "renderer/ground/ground_squares.hpp"

#include <algorithm>

namespace overfly::renderer {

namespace {

class Divider {
 public:
  Divider(const GroundLeaf& leaf, const MeshLimits& limits, GroundCorners& corners)
      : leaf_(leaf), limits_(limits), corners_(corners) {
    if (!leaf.textured) {
      // Ground of one colour shows its shape only at the skyline.
      limits_.max_edge_px *= 2.0;
      limits_.max_error_px *= 8.0;
    }
  }

  void divide(int t, int column, int row) {
    if (!fits(t, column, row)) {
      add_corners(t, column, row);
      const int half = 1 << (t - 1);
      divide(t - 1, column, row);
      divide(t - 1, column + half, row);
      divide(t - 1, column, row + half);
      divide(t - 1, column + half, row + half);
      return;
    }
    add_own_corners(1 << t, column, row);
    squares_.push_back({static_cast<std::uint8_t>(t),
                        static_cast<std::uint8_t>(column),
                        static_cast<std::uint8_t>(row)});
  }

  [[nodiscard]] std::vector<GroundSquare> take() { return std::move(squares_); }

 private:
  [[nodiscard]] bool fits(int t, int column, int row) const {
    if (t == 0) return true;
    const float side_map_m =
        static_cast<float>(leaf_.patch->size_map_m) * static_cast<float>(1 << t) / kPatchCells;
    if (side_map_m * largest(leaf_.px_per_map_m, t, column, row) > limits_.max_edge_px) {
      return false;
    }
    return leaf_.patch->square_error(t, column >> t, row >> t) *
               largest(leaf_.px_per_m_up, t, column, row) <=
           limits_.max_error_px;
  }

  /// Largest value at the outline's points around a square.
  [[nodiscard]] static float largest(const std::array<float, 25>& values,
                                     int t,
                                     int column,
                                     int row) {
    constexpr int kCellsPerOutlineCell = kPatchCells / kOutlineCells;
    constexpr int kOutlinePoints = kOutlineCells + 1;
    const int left = column / kCellsPerOutlineCell;
    const int top = row / kCellsPerOutlineCell;
    const int span = std::max((1 << t) / kCellsPerOutlineCell, 1);
    float result = 0.0F;
    for (int j = top; j <= top + span; ++j) {
      for (int i = left; i <= left + span; ++i) {
        result = std::max(result, values[j * kOutlinePoints + i]);
      }
    }
    return result;
  }

  void add(int column, int row) {
    corners_.add(lattice_point(leaf_.patch->id, column, row),
                 leaf_.patch->point(column, row),
                 leaf_.patch->id.level);
  }

  /// Adds the midpoints of the sides of a square that is divided.
  void add_corners(int t, int column, int row) {
    const int half = 1 << (t - 1);
    add(column + half, row);
    add(column, row + half);
    add(column + 2 * half, row + half);
    add(column + half, row + 2 * half);
  }

  /// Adds the corners that a neighbouring patch may compute differently: those on the patch's rim.
  void add_own_corners(int side, int column, int row) {
    const auto on_rim = [](int i) { return i == 0 || i == kPatchCells; };
    for (const int c : {column, column + side}) {
      for (const int r : {row, row + side}) {
        if (on_rim(c) || on_rim(r)) add(c, r);
      }
    }
  }

  const GroundLeaf& leaf_;
  MeshLimits limits_;
  GroundCorners& corners_;
  std::vector<GroundSquare> squares_;
};

}  // namespace

std::vector<GroundSquare> divide_into_squares(const GroundLeaf& leaf,
                                              const MeshLimits& limits,
                                              GroundCorners& corners) {
  Divider divider(leaf, limits, corners);
  divider.divide(kLog2PatchCells, 0, 0);
  return divider.take();
}

void add_division(const GroundPatch& patch, GroundCorners& corners) {
  constexpr int kCells = kPatchCells / kOutlineCells;
  constexpr int kLast = kOutlineCells;
  constexpr int kMiddle = kOutlineCells / 2;
  for (const auto& [column, row] : {std::pair{kMiddle, 0},
                                    std::pair{0, kMiddle},
                                    std::pair{kLast, kMiddle},
                                    std::pair{kMiddle, kLast}}) {
    corners.add(lattice_point(patch.id, column * kCells, row * kCells),
                patch.outline[row * (kLast + 1) + column],
                patch.id.level);
  }
}

}  // namespace overfly::renderer
