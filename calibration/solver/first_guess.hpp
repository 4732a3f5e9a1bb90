// A first camera and poses, from which the solver starts.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calibration/board.hpp"
#include "calibration/solver/lens_parameters.hpp"
#include "calibration/view.hpp"
#include "core/motion/pose.hpp"

namespace overfly::calibration {

struct Guess {
  CameraModel camera;
  std::vector<Pose> T_camera_board;  ///< of each view
};

/// Searches the focal length, with the principal point in the image's centre and no coefficients:
/// for each candidate the views' homographies give the poses, and the candidate with the smallest
/// reprojection error wins. Unlike Zhang's closed form this needs no pinhole, and it cannot fail by
/// noise.
/// Empty if no candidate puts the board in front of the camera in every view.
[[nodiscard]] std::optional<Guess> first_guess(const Board& board,
                                               const PinholeCamera& size,
                                               const LensChoice& lens,
                                               const std::vector<BoardView>& views);

}  // namespace overfly::calibration
