// The markers of ChArUco boards.
#pragma once

#include <cstdint>
#include <optional>

namespace overfly::calibration {

inline constexpr int kDictionaryMarkers = 250;

/// The cells of a marker of `bits` x `bits` cells, row by row from the top left, the first in the
/// highest of bits * bits bits; 1 = bright. A dark border of one cell surrounds them.
/// @param bits  4, 5 or 6
/// @param id    in [0, kDictionaryMarkers)
[[nodiscard]] std::uint64_t marker_cells(int bits, int id);
[[nodiscard]] bool marker_cell(int bits, std::uint64_t cells, int row, int col);

struct MarkerMatch {
  int id = 0;
  /// Quarter turns, anticlockwise, that make the cells those of the dictionary.
  int turns = 0;
};

/// The marker with exactly these cells, in any of the four orientations. Wrong cells are not
/// corrected: a calibration has many markers, and a wrong one costs more than a missing one.
[[nodiscard]] std::optional<MarkerMatch> find_marker(int bits, std::uint64_t cells);

}  // namespace overfly::calibration
