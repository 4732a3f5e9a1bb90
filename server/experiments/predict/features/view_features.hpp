// Geometry of a camera's view of the ground: relief, motion, overlap.
#pragma once

#include "core/camera/camera_model.hpp"
#include "core/motion/pose.hpp"
#include "server/missions/camera_view.hpp"

namespace overfly::server::predict {

/// Range of the heights of the ground in the view over the median height of the camera above them;
/// 0 if the camera does not see the ground.
[[nodiscard]] double relief_over_height(const CameraView& view);

/// Motion of the image between a view and another pose [px]: RMS over the grid, the ground where it
/// is seen, else the direction.
[[nodiscard]] double image_motion_px(const CameraModel& camera,
                                     const CameraView& view,
                                     const Pose& T_world_next);

/// Share of the view's image that is in the image at another pose, in [0, 1]. Each point of the
/// grid stands for its part of the image, which is moved as the point and not turned.
[[nodiscard]] double overlap_with(const CameraModel& camera,
                                  const CameraView& view,
                                  const Pose& T_world_next);

}  // namespace overfly::server::predict
