// Options of the ray-caster for tests.
#pragma once

#include <cstddef>
#include <memory>

#include "renderer/raycast/paint/sample.hpp"
#include "renderer/renderer.hpp"

namespace overfly::renderer::raycast {

struct RaycastOptions {
  std::size_t tile_cache_bytes = std::size_t{256} << 20U;
  std::shared_ptr<TileStore> tile_store;  ///< null = a private one
  int threads = 0;                        ///< 0 = one per core, at most 8
  const SampleKernel* kernel = nullptr;   ///< null = the fastest
};

}  // namespace overfly::renderer::raycast
