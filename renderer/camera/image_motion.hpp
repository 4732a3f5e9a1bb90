// Motion of the image during exposure and readout.
#pragma once

#include <cstdint>

#include "core/earth/height_query.hpp"
#include "renderer/renderer.hpp"

namespace overfly::renderer {

/// Largest displacement of a ground point's pixel between two poses of a camera, over a grid of
/// points of the image [px]. The ground is assumed to be level at its height below the camera;
/// above the horizon only the rotation counts.
[[nodiscard]] double largest_motion_px(const CameraModel& camera,
                                       const Pose& T_world_camera_before,
                                       const Pose& T_world_camera_after,
                                       const HeightQuery& ground);

/// Number of instants that sample the exposure: two per pixel of the longest streak, in [1,
/// kMaxInstants]; 1 for streaks below 0.05 px.
inline constexpr int kMaxInstants = 128;
[[nodiscard]] int exposure_instants(const CameraRequest& request, const HeightQuery& ground);

/// Number of rows of a rolling shutter that may share a pose: within them the image moves by at
/// most 0.05 px relative to the middle row. All rows for a global shutter.
[[nodiscard]] int rows_of_one_pose(const CameraRequest& request, const HeightQuery& ground);

}  // namespace overfly::renderer
