// Calibration boards. Board frame: origin at the first inner corner, x along the columns, y along
// the rows, z away from a viewer of the printed side, so that a camera in front of the board sees
// x right, y down at a rotation of zero. Metres.
#pragma once

#include <Eigen/Core>
#include <string>

#include "core/result.hpp"

namespace overfly::calibration {

/// A chequerboard of `cols` x `rows` inner corners, hence of (cols + 1) x (rows + 1) squares. The
/// square between the inner corners (0, 0) and (1, 1) is dark.
struct Board {
  int cols = 0;           ///< inner corners along x, in [3, 60]
  int rows = 0;           ///< inner corners along y, in [3, 60]
  double square_m = 0.0;  ///< side of a square, in (0, 10]

  /// Errors: kInvalidArgument naming field, value and limit.
  [[nodiscard]] Status validate() const;

  /// True if the board looks the same after half a turn, so that an image does not determine which
  /// corner is the first. Half a turn moves square (i, j) to (cols - i, rows - j). Its colour is
  /// the parity of i + j, which is kept exactly if cols + rows is even: both odd, or both even.
  ///
  /// The intrinsics do not depend on the choice, because half a turn about the centre maps the
  /// corners onto each other. The board's pose does: it is wrong by half a turn in some images.
  [[nodiscard]] bool half_turn_symmetric() const { return (cols + rows) % 2 == 0; }

  [[nodiscard]] int corner_count() const { return cols * rows; }
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
