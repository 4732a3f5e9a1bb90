// How far the picture moves while it is exposed and read out.
#pragma once

#include <cstdint>

#include "core/height_query.hpp"
#include "renderer/renderer.hpp"

namespace overfly::renderer {

/// Largest displacement of a ground point's pixel between two poses of a camera, over a grid of
/// points of the image [px]. The ground is taken as level at its height below the camera; above
/// the horizon only the rotation counts.
[[nodiscard]] double largest_motion_px(const CameraModel& camera,
                                       const Pose& T_world_camera_before,
                                       const Pose& T_world_camera_after,
                                       const HeightQuery& ground);

/// How many instants stand for the exposure: two for each pixel of the longest streak, in
/// [1, kMaxInstants]; 1 for streaks below 0.05 px.
inline constexpr int kMaxInstants = 128;
[[nodiscard]] int exposure_instants(const CameraRequest& request, const HeightQuery& ground);

/// How many rows of a rolling shutter may share a pose: within them the picture moves by at most
/// 0.05 px from that of the middle one. All of them for a global shutter.
[[nodiscard]] int rows_of_one_pose(const CameraRequest& request, const HeightQuery& ground);

}  // namespace overfly::renderer
