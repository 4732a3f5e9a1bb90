// Motion of the image during exposure and readout.
#pragma once

#include <cstdint>
#include <vector>

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

/// An instant that samples the exposure.
struct ExposureInstant {
  std::int64_t offset_ns = 0;  ///< from the middle of the exposure
  float weight = 1.0F;         ///< of its light in the mean; those of an exposure add up to 1
};

/// The most instants of an exposure.
inline constexpr int kMaxInstants = 128;
/// Instants and weights of Gauss-Legendre quadrature over the exposure: one per pixel of the
/// longest streak and one more, at most kMaxInstants; a single one for streaks below 0.25 px. For
/// streaks up to 127 px, light with a period of 8, 4 and 2 px on the image has errors of at most
/// 0.2, 0.7 and 2.7 % of its amplitude. The streak is the motion over 8 pieces of exposure and
/// readout, cut at the request's poses as well if they show more motion (a vibration).
[[nodiscard]] std::vector<ExposureInstant> exposure_instants(const CameraRequest& request,
                                                             const HeightQuery& ground);

/// Number of rows of a rolling shutter that may share a pose: within them the image moves by at
/// most 0.05 px relative to the middle row. All rows for a global shutter. The motion is measured
/// likewise, in 16 pieces of the readout.
[[nodiscard]] int rows_of_one_pose(const CameraRequest& request, const HeightQuery& ground);

}  // namespace overfly::renderer
