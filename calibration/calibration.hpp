// Estimates a camera from views of a board, with what a reader needs to judge the result.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "calibration/board.hpp"
#include "calibration/coverage.hpp"
#include "calibration/solver/lens_parameters.hpp"
#include "calibration/view.hpp"
#include "core/camera/camera_model.hpp"
#include "core/motion/pose.hpp"
#include "core/result.hpp"

namespace overfly::calibration {

inline constexpr std::size_t kLeastViews = 4;
inline constexpr std::size_t kMostViews = 1000;

/// Standard deviations of the estimates by the noise of the corners.
struct CameraDeviation {
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  std::array<double, 5> k{};  ///< as Distortion::k
};

struct CalibratedView {
  Pose T_camera_board;
  double tilt_rad = 0.0;  ///< between the optical axis and the board's normal
  double rms_px = 0.0;    ///< root mean square of the distances of its corners
  double max_px = 0.0;
  /// Its RMS is more than three times the median of all views, and more than 0.1 px: the board was
  /// bent or moved, or its corners are wrong. It has no part in the estimate.
  bool outlier = false;
};

struct Calibration {
  CameraModel camera;
  CameraDeviation deviation;
  std::vector<CalibratedView> views;  ///< as given
  double rms_px = 0.0;                ///< over the corners of all views that are not outliers
  double max_px = 0.0;
  std::vector<CoverageBar> coverage;
};

/// @param size   of the images; its intrinsics are ignored
/// @param views  each with at least four corners, not on a line
/// Errors: kInvalidArgument if `size`, the board or the number of views is outside its limits, and
/// if the views do not determine the camera: the focal length must follow to 2 % for corners with a
/// noise of at least 0.1 px. Views that are all parallel to the image do not determine it.
[[nodiscard]] Result<Calibration> calibrate(const Board& board,
                                            const PinholeCamera& size,
                                            const LensChoice& lens,
                                            const std::vector<BoardView>& views);

}  // namespace overfly::calibration
