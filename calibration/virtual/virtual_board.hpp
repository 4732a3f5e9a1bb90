// Images of a board with a known pose, drawn through a camera model.
#pragma once

#include "calibration/board.hpp"
#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"
#include "core/motion/pose.hpp"

namespace overfly::calibration {

/// Radiances of the parts of a virtual board (1 = white in the imagery).
struct BoardPaint {
  float dark = 0.04F;
  float bright = 0.75F;
  float background = 0.25F;
};

/// Width of the bright border around the squares, in squares.
inline constexpr int kBoardBorder = 1;

/// Draws a board. Each pixel is the mean over its area [x - 1/2, x + 1/2] x [y - 1/2, y + 1/2]: the
/// pixel's corners are cast onto the board exactly (CameraModel::ray), and a pixel that no edge
/// crosses has one colour. Others take 256 samples (Hammersley points; van der Corput 1935), whose
/// places on the board are bilinear between the corners' (deviation below 1e-3 px).
/// @param T_camera_board  may put parts of the board outside the image
/// @pre the camera and the board are valid
[[nodiscard]] RadianceImage draw_board(const CameraModel& camera,
                                       const Board& board,
                                       const Pose& T_camera_board,
                                       const BoardPaint& paint = {});

}  // namespace overfly::calibration
