// Images of a board with a known pose, drawn through a camera model.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

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

/// Draws boards through one camera. Keeps the rays of the pixels' corners, because through a lens
/// they take longer to find than the rest of a picture.
class BoardPainter {
 public:
  /// 64 MiB, a camera of 4 megapixels. Those of larger cameras are found for each picture.
  static constexpr std::size_t kMostKeptRays = std::size_t{1} << 22U;

  /// @pre the camera is valid
  explicit BoardPainter(const CameraModel& camera);

  [[nodiscard]] const CameraModel& camera() const { return camera_; }

  /// Each pixel is the mean over its area [x - 1/2, x + 1/2] x [y - 1/2, y + 1/2]: the pixel's
  /// corners are cast onto the board exactly (CameraModel::ray), and a pixel that no edge crosses
  /// has one colour. Others take 256 samples (Hammersley points; van der Corput 1935), whose places
  /// on the board are bilinear between the corners' (deviation below 1e-3 px).
  /// @param T_camera_board  may put parts of the board outside the image
  /// @pre the board is valid
  [[nodiscard]] RadianceImage draw(const Board& board,
                                   const Pose& T_camera_board,
                                   const BoardPaint& paint = {}) const;

 private:
  CameraModel camera_;
  /// Of the corners of the pixels, (width + 1) x (height + 1), row by row: x and y at z = 1; NaN
  /// where the camera has none. Empty if they would be too many.
  std::vector<Eigen::Vector2d> rays_;
};

}  // namespace overfly::calibration
