// Measures a frame's imagery statistics with separate rays.
#pragma once

#include <functional>

#include "renderer/camera/frame_statistics.hpp"
#include "renderer/raycast/ground/ground_caster.hpp"
#include "renderer/raycast/ground/shutter.hpp"
#include "renderer/worker_pool.hpp"

namespace overfly::renderer::raycast {

/// True if there is imagery; called by several threads at once.
/// @param u,  v  texels of level 0
/// @param lod  level of detail at which it is drawn
using ImageryAt = std::function<bool(double u, double v, double lod)>;

/// Measures on the same 40 x 30 rays as measure_frame(); determines the axis depth by casting a
/// ray.
/// @param poses  of the rows at mid exposure
[[nodiscard]] FrameStatistics measure_rays(const CameraModel& camera,
                                           const ShutterPoses& poses,
                                           const Pose& T_world_camera,
                                           const GroundCaster& caster,
                                           const terrain::TileSource& tiles,
                                           const ImageryAt& has_imagery,
                                           WorkerPool& pool);

}  // namespace overfly::renderer::raycast
