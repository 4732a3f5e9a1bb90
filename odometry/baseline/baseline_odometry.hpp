// Simple baselines: what an aircraft gets without visual odometry, or with the simplest one. An
// estimator that does not beat them is of no use.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "core/motion/pose.hpp"
#include "core/result.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::odometry::baseline {

/// "baseline_hold": reports the first pose for ever.
[[nodiscard]] std::unique_ptr<VoPort> create_hold();

struct HomographyParameters {
  int features = 400;          ///< corners in a reference image, in [20, 5000]
  double reference_px = 60.0;  ///< median motion after which a new reference image is taken, > 0
};

/// Upper bound of the memory of its own images [bytes per pixel of the camera], measured: the
/// search for corners takes 24, beside the previous image.
inline constexpr double kHomographyBytesPerPx = 25.0;

/// Errors: kInvalidArgument naming an unknown key, or field, value and limit.
[[nodiscard]] Result<HomographyParameters> homography_parameters_from(
    const std::map<std::string, double>& values);

/// "baseline_homography": level flight over level ground. Corners are followed to a reference image
/// by optical flow; the homography between the two images gives rotation and horizontal motion in
/// units of the height, which is taken to be constant. The first image is taken to look straight
/// down.
[[nodiscard]] std::unique_ptr<VoPort> create_homography(const HomographyParameters& parameters);

/// "baseline_dead_reckoning": airspeed, compass and, where there are samples of them, gyroscopes,
/// accelerometers and barometer; no image. Metres. Wind is not known.
/// @param T_body_camera  mount of the camera
[[nodiscard]] std::unique_ptr<VoPort> create_dead_reckoning(const Pose& T_body_camera);

}  // namespace overfly::odometry::baseline
