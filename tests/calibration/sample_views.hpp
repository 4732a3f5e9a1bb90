// Cameras, boards and views with known truth.
#pragma once

#include <cstdint>
#include <vector>

#include "calibration/board.hpp"
#include "calibration/view.hpp"
#include "core/camera/camera_model.hpp"
#include "core/camera/image.hpp"
#include "core/motion/pose.hpp"

namespace overfly::calibration {

inline const Board kSampleBoard{9, 6, 0.03};
inline constexpr PinholeCamera kSampleSize{640, 480, 0.0, 0.0, 0.0, 0.0};

[[nodiscard]] CameraModel pinhole_camera();
[[nodiscard]] CameraModel radtan_camera();       ///< k3 = 0
[[nodiscard]] CameraModel equidistant_camera();  ///< 129 deg across the diagonal

/// The exact corners of each pose, moved by normal noise of `noise_px` in each coordinate.
[[nodiscard]] std::vector<BoardView> exact_views(const CameraModel& camera,
                                                 const Board& board,
                                                 const std::vector<Pose>& T_camera_board,
                                                 double noise_px = 0.0,
                                                 std::uint64_t seed = 1);

/// Blurred as by a lens: binomial weights 1 2 1 in both directions, a standard deviation of 0.7 px.
[[nodiscard]] RadianceImage slightly_blurred(const RadianceImage& sharp);

/// A radiance of 1 is 255.
[[nodiscard]] Image grey_from(const RadianceImage& radiance);

}  // namespace overfly::calibration
