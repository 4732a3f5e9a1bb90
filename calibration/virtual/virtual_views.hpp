// Poses from which a person would show a board to a camera: everywhere in the image, near and far,
// tilted in all directions.
#pragma once

#include <cstdint>
#include <vector>

#include "calibration/board.hpp"
#include "core/camera/camera_model.hpp"
#include "core/motion/pose.hpp"

namespace overfly::calibration {

/// T_camera_board of views that show the whole board with its border. Their centres go through a
/// grid of 3 x 3 parts of the image; the board fills a quarter to three fifths of the image's
/// width, is tilted by 15 to 45 deg about a random axis, and turned by up to 30 deg in its plane.
/// @param count  wanted; the result has fewer only if the board fits into no part of the image
/// @param seed   the result is a function of it
[[nodiscard]] std::vector<Pose> virtual_views(const CameraModel& camera,
                                              const Board& board,
                                              int count,
                                              std::uint64_t seed);

}  // namespace overfly::calibration
