// Checks requests to a renderer, the same way for every implementation.
#pragma once

#include "core/camera/camera.hpp"
#include "core/motion/pose.hpp"
#include "core/result.hpp"
#include "renderer/renderer.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::renderer {

inline constexpr int kMaxImageSidePx = 8192;
inline constexpr double kMaxDepthBelowGroundM = 1.0;

/// Errors: kInvalidArgument for an invalid or too large camera, times below 0, an invalid
/// atmosphere, a pose that is not finite, or an optical centre more than kMaxDepthBelowGroundM
/// below the ground.
[[nodiscard]] Status check_camera_request(const terrain::TileSource& tiles,
                                          const CameraRequest& request);

/// The pinhole camera of a scene view. Errors: kInvalidArgument naming the field.
[[nodiscard]] Result<PinholeCamera> camera_of(const SceneView& view);

}  // namespace overfly::renderer
