// The CPU ray-caster.
#pragma once

#include <memory>

#include "renderer/raycast/raycast_options.hpp"
#include "renderer/renderer.hpp"

namespace overfly::renderer::raycast {

/// Neither `threads` nor `kernel` changes an image.
[[nodiscard]] std::unique_ptr<Renderer> create_raycaster(
    std::shared_ptr<const terrain::TileSource> tiles, const RaycastOptions& options);

}  // namespace overfly::renderer::raycast
