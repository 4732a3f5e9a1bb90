// Calibration boards. Board frame: origin at the first inner corner, x along the columns, y along
// the rows, z away from a viewer of the printed side, so that a camera in front of the board sees
// x right, y down at a rotation of zero. Metres.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "core/result.hpp"

namespace overfly::calibration {

/// The markers in the bright squares of a ChArUco board.
struct BoardMarkers {
  int bits = 4;         ///< cells a side: 4, 5 or 6, of the dictionaries DICT_nXn_50 to _250
  double side_m = 0.0;  ///< with the dark border; in [0.3, 0.9] squares
};

/// A chequerboard of `cols` x `rows` inner corners, hence of (cols + 1) x (rows + 1) squares.
/// Square (i, j) begins at the inner corner (i, j); its numbers begin at -1. It is dark if i + j is
/// even, so the square at the board's top left is. With markers it is a ChArUco board as OpenCV
/// draws it since version 4.6.
struct Board {
  int cols = 0;           ///< inner corners along x, in [3, 60]
  int rows = 0;           ///< inner corners along y, in [3, 60]
  double square_m = 0.0;  ///< side of a square, in (0, 10]
  std::optional<BoardMarkers> markers = std::nullopt;

  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;

  /// True if the board looks the same after half a turn, so that an image does not determine which
  /// corner is the first. Half a turn moves square (i, j) to (cols - i, rows - j). Its colour is
  /// the parity of i + j, which is kept exactly if cols + rows is even: both odd, or both even.
  ///
  /// The intrinsics do not depend on the choice, because half a turn about the centre maps the
  /// corners onto each other. The board's pose does: it is wrong by half a turn in some images.
  /// Markers remove the symmetry.
  [[nodiscard]] bool half_turn_symmetric() const { return !markers && (cols + rows) % 2 == 0; }

  [[nodiscard]] int corner_count() const { return cols * rows; }
  /// Of the bright squares. Their ids go row by row from the top left.
  [[nodiscard]] int marker_count() const { return (cols + 1) * (rows + 1) / 2; }
  /// Square of a marker. @pre 0 <= id < marker_count()
  [[nodiscard]] Eigen::Vector2i marker_square(int id) const;
  /// Marker of a square; empty for a dark square and outside the squares.
  [[nodiscard]] std::optional<int> marker_of(int i, int j) const;
  /// Distance from a square's edge to its marker, in squares. @pre markers
  [[nodiscard]] double marker_gap() const { return 0.5 * (1.0 - markers->side_m / square_m); }
  /// Corner `id` = row * cols + column. @pre 0 <= id < corner_count()
  [[nodiscard]] Eigen::Vector2d corner_m(int id) const {
    return {(id % cols) * square_m, (id / cols) * square_m};
  }
};

/// "COLSxROWS" in inner corners, e.g. "9x6". Errors: kInvalidArgument.
[[nodiscard]] Result<Board> board_from_text(const std::string& text, double square_m);

/// Errors: kInvalidArgument for a half-turn symmetric board, with the nearest sizes that are not.
[[nodiscard]] Status require_unambiguous(const Board& board);

}  // namespace overfly::calibration
