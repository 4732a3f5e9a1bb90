// Finds the inner corners of a ChArUco board in an image.
#pragma once

#include <optional>

#include "calibration/board.hpp"
#include "calibration/view.hpp"
#include "core/camera/image.hpp"

namespace overfly::calibration {

/// A view needs this many corners, in at least three columns and three rows.
inline constexpr int kLeastCharucoCorners = 8;

/// Finds the inner corners next to visible markers, or nothing: the board may be partly outside the
/// image or covered. The markers predict the corners (each through its own homography, which lens
/// distortion hardly affects), and gradients refine them.
/// @param image  8-bit grey
/// @pre board.markers
/// Throws cv::Exception.
[[nodiscard]] std::optional<BoardView> detect_charuco(const Image& image, const Board& board);

}  // namespace overfly::calibration
