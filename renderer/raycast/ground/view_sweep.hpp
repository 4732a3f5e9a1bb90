// Bounds of a view during its exposure.
#pragma once

#include "renderer/raycast/ground/height_field.hpp"
#include "renderer/raycast/ground/ray_grid.hpp"
#include "renderer/renderer.hpp"

namespace overfly::renderer::raycast {

/// Bounds of all rays of a request, over all rows and their whole exposures.
[[nodiscard]] ViewSweep sweep_of(const CameraRequest& request, const RayGrid& rays);

}  // namespace overfly::renderer::raycast
