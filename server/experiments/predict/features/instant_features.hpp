// The features of one instant, from patches of the image and the camera's poses.
#pragma once

#include <cstdint>
#include <optional>

#include "core/camera/camera_model.hpp"
#include "core/motion/pose.hpp"
#include "server/experiments/predict/features/features.hpp"
#include "server/experiments/predict/features/patch_camera.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::server::predict {

/// Poses of the camera, T_world_camera.
struct ViewPoses {
  Pose now;
  Pose next_frame;
  Pose later;  ///< kOverlapS later
};

/// @param t_ns  of the shot
/// @param sun_elevation_deg  as Features::sun_elevation_deg
[[nodiscard]] Features features_of(const CameraModel& camera,
                                   const PatchShot& shot,
                                   std::int64_t t_ns,
                                   const ViewPoses& poses,
                                   const terrain::TileSource& tiles,
                                   const std::optional<double>& sun_elevation_deg);

}  // namespace overfly::server::predict
