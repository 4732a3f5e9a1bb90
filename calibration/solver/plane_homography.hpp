// Homographies of a plane, and the plane's pose from them.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/motion/pose.hpp"

namespace overfly::calibration {

struct PlanePair {
  Eigen::Vector2d plane;  ///< on the plane
  Eigen::Vector2d image;  ///< in the image
};

/// The homography H with image ~ H plane, by the normalised direct linear transform (Hartley,
/// Zisserman 2004, algorithm 4.2). Empty for fewer than four pairs, or pairs on one line.
[[nodiscard]] std::optional<Eigen::Matrix3d> homography(const std::vector<PlanePair>& pairs);

/// Pose of the plane in front of a camera, from the homography onto the ideal image plane z = 1:
/// its columns are r1, r2, t up to scale (Zhang 2000, section 3.1), made a rotation by the nearest
/// one. Empty if the plane's origin is not in front of the camera.
[[nodiscard]] std::optional<Pose> plane_pose(const Eigen::Matrix3d& H);

}  // namespace overfly::calibration
