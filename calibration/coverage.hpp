// How well views of a board cover the image, the distances and the tilts.
#pragma once

#include <string>
#include <vector>

#include "calibration/board.hpp"
#include "calibration/view.hpp"

namespace overfly::calibration {

/// Where and how a view shows the board: the measures of ROS's camera_calibration (Bowman,
/// Mihelich; wiki.ros.org/camera_calibration), each in [0, 1].
struct ViewMeasures {
  double x = 0.0;     ///< of the board in the image, 0 = left, 1 = right edge
  double y = 0.0;     ///< 0 = top, 1 = bottom
  double size = 0.0;  ///< square root of the part of the image that the outer corners enclose
  double skew = 0.0;  ///< by how much the angle at a corner differs from 90 deg, in half radians
};

/// Of a view without all corners: of the smallest rectangle on the board around those that it has.
/// @pre the view has corners that determine a homography
[[nodiscard]] ViewMeasures measures_of(const BoardView& view,
                                       const Board& board,
                                       int width_px,
                                       int height_px);

/// By how much two views differ: the sum of the differences of their measures.
[[nodiscard]] double novelty(const ViewMeasures& a, const ViewMeasures& b);

/// One bar: the range of a measure over the views, compared with the range that is enough.
struct CoverageBar {
  std::string name;  ///< "x", "y", "size", "skew"
  double min = 0.0;
  double max = 0.0;
  double progress = 0.0;  ///< in [0, 1]; 1 = enough
};

/// The bars x, y, size and skew. Enough is a range of 0.7 in x and y, a size of 0.4 and a skew of
/// 0.5, as for ROS; small boards and straight views add nothing, so the ranges of size and skew
/// begin at 0. Empty views give bars of 0.
[[nodiscard]] std::vector<CoverageBar> coverage_bars(const std::vector<ViewMeasures>& views);

/// Mean distance between the corners that two views share [px]; infinite if they share none.
[[nodiscard]] double mean_shift_px(const BoardView& a, const BoardView& b);

}  // namespace overfly::calibration
