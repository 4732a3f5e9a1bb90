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
/// Limit of each component of a camera's position: beyond, indices of tiles overflow, and neither
/// the tangent frame nor a map projection describes the ground.
inline constexpr double kMaxPositionM = 1e6;
inline constexpr double kMaxSpeedMPerS = 1e4;  ///< of each component of a camera's velocity

/// Errors: kInvalidArgument for an invalid or too large camera, exposure or readout times outside
/// [0, 1 s], an invalid atmosphere, a velocity beyond kMaxSpeedMPerS, a pose that is not finite or
/// beyond kMaxPositionM, or an optical centre more than kMaxDepthBelowGroundM below the ground.
[[nodiscard]] Status check_camera_request(const terrain::TileSource& tiles,
                                          const CameraRequest& request);

/// The pinhole camera of a scene view. Errors: kInvalidArgument naming the field.
[[nodiscard]] Result<PinholeCamera> camera_of(const SceneView& view);

}  // namespace overfly::renderer
