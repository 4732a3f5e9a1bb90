// What a frame's record says about the imagery under it, from rays of its own.
#pragma once

#include <functional>

#include "renderer/camera/frame_statistics.hpp"
#include "renderer/raycast/ground/ground_caster.hpp"
#include "renderer/raycast/ground/shutter.hpp"
#include "renderer/raycast/worker_pool.hpp"

namespace overfly::renderer::raycast {

/// True where there is imagery; called by several threads at once. @param u, v  texels of level 0;
/// @param lod  at which it is drawn
using ImageryAt = std::function<bool(double u, double v, double lod)>;

/// Measures on the same 40 x 30 rays as measure_frame() does; the axis depth by casting it.
/// @param poses  of the rows at mid exposure
[[nodiscard]] FrameStatistics measure_rays(const CameraModel& camera,
                                           const ShutterPoses& poses,
                                           const Pose& T_world_camera,
                                           const GroundCaster& caster,
                                           const HeightQuery& ground,
                                           const ImageryAt& has_imagery,
                                           WorkerPool& pool);

}  // namespace overfly::renderer::raycast
