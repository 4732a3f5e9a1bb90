// Tiles in the renderers' formats, in memory within a budget, read ahead by the store's threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "core/result.hpp"
#include "renderer/renderer.hpp"
#include "renderer/tiles/tile_pixels.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::renderer {

struct TileStoreOptions {
  std::size_t budget_bytes = std::size_t{512} << 20U;
  int threads = 1;  ///< read-ahead threads; 0 = none, every tile is read on request
};

/// Statistics of the store.
struct TileStoreCounts {
  std::int64_t read_on_demand = 0;  ///< tiles that a `get` had to wait for
  std::int64_t read_ahead = 0;      ///< tiles that the store's threads read
  std::int64_t let_go = 0;          ///< tiles evicted to keep the budget
  double ahead_cpu_s = 0.0;         ///< CPU time of the store's threads
};

/// Thread-safe. Which tiles are in memory does not affect the values that `get` returns.
class TileStore {
 public:
  TileStore(std::shared_ptr<const terrain::TileSource> tiles, const TileStoreOptions& options);
  ~TileStore();
  TileStore(const TileStore&) = delete;
  TileStore& operator=(const TileStore&) = delete;

  /// The tile, read now if it is not in memory. Errors: kIo naming the tile if it cannot be read.
  [[nodiscard]] Result<std::shared_ptr<const TilePixels>> get(const terrain::TileId& id,
                                                              PixelFormat format);
  /// Reads the tiles that are not in memory, on the store's threads and the caller's at once: to be
  /// called before `get` or `find` is called for each of many. An error is reported by `get`.
  /// @param limit_ns  no tile is begun later on the caller's thread; the store's threads go on.
  ///     Limited, it also waits so long for tiles that other threads are reading
  void load(std::span<const terrain::TileId> ids,
            PixelFormat format,
            std::int64_t limit_ns = kForAllTiles);
  /// The tile if it is in memory; else null, and the tile is requested (without threads: read).
  [[nodiscard]] std::shared_ptr<const TilePixels> find(const terrain::TileId& id,
                                                       PixelFormat format);
  /// The tile if it is in memory, else null.
  [[nodiscard]] std::shared_ptr<const TilePixels> peek(const terrain::TileId& id,
                                                       PixelFormat format);
  /// Requests tiles that will be needed, most urgent first; replaces the previous request. Tiles
  /// used since the last call but one are not evicted to make room for them.
  void prefetch(std::span<const terrain::TileId> ids, PixelFormat format);
  /// Requests tiles that may be needed some time. They are read when there is nothing else to read,
  /// and only while no other tile has to be evicted for them.
  void read_when_idle(std::span<const terrain::TileId> ids, PixelFormat format);
  /// Waits until the threads are idle.
  void wait_until_idle();

  /// Bytes of the tiles in the store; evicted tiles that are still in use elsewhere do not count.
  [[nodiscard]] std::size_t held_bytes() const;
  [[nodiscard]] TileStoreCounts counts() const;
  [[nodiscard]] const terrain::TileSource& tiles() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace overfly::renderer
