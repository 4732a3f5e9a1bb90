// Errors of an estimate over the last part of the path, for plots over time.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/motion/pose.hpp"

namespace overfly::evaluation {

/// Length of the part.
inline constexpr double kErrorWindow_m = 100.0;
/// Earlier poses that are searched: 100 m at 2.6 m/s with 31 frames per second.
inline constexpr std::size_t kMaxWindowPoses = 1200;

/// A camera at an instant: where it truly was, and where the aligned estimate says it was.
struct PosePair {
  int map_id = 0;
  Pose T_world_camera;
  Pose T_world_camera_estimate;
  double detour_m = 0.0;  ///< MatchedPose::detour_m since the pose before
};

/// Scale of the estimate over the last 100 m against the truth: between an instant and the last one
/// that truly was at least kErrorWindow_m away, the estimated distance divided by the true one,
/// minus 1. 0 = the alignment's scale holds; 0.01 = the estimate is 1 % too large here. Empty where
/// no earlier pose of the same map is far enough away.
/// @param poses  of successive instants; empty where there is no estimate
/// @pre poses[at] is not empty
[[nodiscard]] std::optional<double> scale_error_at(std::span<const std::optional<PosePair>> poses,
                                                   std::size_t at);

/// Of one pair of poses, as relative_errors() averages them.
struct RelativeErrorAt {
  double translation = 0.0;     ///< position error / kErrorWindow_m
  double rotation_rad_m = 0.0;  ///< rotation error / kErrorWindow_m
};

/// Relative error of the pose at an instant to the last one from which the true path to it is
/// longer than kErrorWindow_m (Geiger, Lenz, Urtasun 2012, sec. 3, of the pair that ends here).
/// Empty where no earlier pose of the same map is far enough away.
/// @param poses  as for scale_error_at
/// @return one entry for each pose
[[nodiscard]] std::vector<std::optional<RelativeErrorAt>> relative_errors_along(
    std::span<const std::optional<PosePair>> poses);

}  // namespace overfly::evaluation
