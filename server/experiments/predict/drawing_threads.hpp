// Divides work that needs a renderer among threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>

#include "core/result.hpp"
#include "renderer/renderer.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::server::predict {

struct DrawingThreads {
  std::shared_ptr<const terrain::TileSource> tiles;
  unsigned jobs = 1;
  const std::atomic<bool>* cancel = nullptr;
  /// Called with the share done, by one thread at a time; may be empty.
  std::function<void(double)> progress;
};

/// Calls `work` for each of [0, count), with a ray-casting renderer of the thread that it runs on;
/// all renderers share one store of tiles. Results must not depend on the order of the calls.
/// @return the error of a call; kCancelled. Calls that have not begun are then left out.
[[nodiscard]] Status draw_all(const DrawingThreads& threads,
                              std::size_t count,
                              const std::function<Status(std::size_t, renderer::Renderer&)>& work);

}  // namespace overfly::server::predict
