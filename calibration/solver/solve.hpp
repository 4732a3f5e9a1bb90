// Least-squares estimate of a camera and of the board's poses.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "calibration/board.hpp"
#include "calibration/solver/first_guess.hpp"
#include "calibration/solver/lens_parameters.hpp"
#include "calibration/view.hpp"
#include "core/motion/pose.hpp"
#include "core/result.hpp"

namespace overfly::calibration {

struct ViewFitQuality {
  double rms_px = 0.0;  ///< root mean square of the corners' distances from their projections
  double max_px = 0.0;
};

struct Solution {
  CameraModel camera;
  std::vector<Pose> T_camera_board;     ///< of each view
  std::vector<ViewFitQuality> quality;  ///< of each view
  double rms_px = 0.0;                  ///< over all corners, as that of OpenCV
  /// Of the noise of one coordinate [px]: residuals over degrees of freedom.
  double sigma_px = 0.0;
  /// Covariance of the parameters (lens_parameters.hpp) for a noise of 1 px; scale by sigma_px^2.
  Eigen::MatrixXd unit_covariance;
};

/// Minimises the sum of the squared distances between corners and their projections.
///
/// Method: Levenberg and Marquardt (Marquardt 1963) on the camera and the six parameters of each
/// view, whose blocks are eliminated first (Schur complement; Triggs et al. 2000, section 6.1). The
/// covariance is the inverse of the reduced normal matrix.
/// @pre views are not empty, and each has at least four corners
/// Errors: kInvalidArgument if the views do not determine the parameters: the normal matrix is
/// singular, or the steps do not converge.
[[nodiscard]] Result<Solution> solve(const Board& board,
                                     const LensChoice& lens,
                                     const std::vector<BoardView>& views,
                                     const Guess& start);

}  // namespace overfly::calibration
