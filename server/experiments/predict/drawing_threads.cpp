#include "server/experiments/predict/drawing_threads.hpp"

#include <mutex>

#include "core/cancel.hpp"
#include "core/helper_threads.hpp"
#include "renderer/tiles/tile_store.hpp"

namespace overfly::server::predict {

Status draw_all(const DrawingThreads& threads,
                std::size_t count,
                const std::function<Status(std::size_t, renderer::Renderer&)>& work) {
  renderer::RendererOptions options;
  options.threads = 1;
  renderer::TileStoreOptions store;
  store.threads = 0;  // nothing is read ahead
  options.tile_store = std::make_shared<renderer::TileStore>(threads.tiles, store);
  std::mutex mutex;
  Status failure;
  std::size_t done = 0;
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stopped{false};
  const auto draw = [&] {
    const auto renderer = renderer::create_raycast_renderer(threads.tiles, options);
    for (std::size_t i = next++; i < count && !stopped; i = next++) {
      Status status = is_cancelled(threads.cancel)
                          ? Status(Error{ErrorCode::kCancelled, "the prediction was cancelled"})
                          : work(i, *renderer);
      const std::lock_guard lock(mutex);
      if (!status) {
        stopped = true;
        if (failure) failure = status;
        return;
      }
      ++done;
      if (threads.progress) {
        threads.progress(static_cast<double>(done) / static_cast<double>(count));
      }
    }
  };
  work_with_helpers(threads.jobs > 1 ? threads.jobs - 1 : 0, draw);
  if (!failure) return failure;
  return threads.tiles->status();
}

}  // namespace overfly::server::predict
