// Finds a board's corners in an image.
#pragma once

#include <optional>

#include "calibration/board.hpp"
#include "calibration/view.hpp"
#include "core/camera/image.hpp"
#include "core/result.hpp"

namespace overfly::calibration {

/// Finds all inner corners of a chequerboard, or nothing; of a ChArUco board those that are visible
/// (detect_charuco.hpp).
///
/// Method: OpenCV's sector-based detector (Duda, Frese 2018, "Accurate detection and localization
/// of checkerboard corners for calibration", BMVC), then gradients around each corner. The colours
/// of the squares decide which corner is the first (board.hpp); on a half-turn symmetric board it
/// may be either of two.
/// @param image  8-bit grey, sides of 16 to 16384 px
/// @pre board.validate()
/// Errors: kInvalidArgument for another image; kInternal if OpenCV fails.
[[nodiscard]] Result<std::optional<BoardView>> detect_board(const Image& image, const Board& board);

}  // namespace overfly::calibration
