// Tiles as renderers draw them, in memory within a budget, fetched ahead by threads of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/image.hpp"
#include "core/result.hpp"
#include "renderer/renderer.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::renderer {

/// One tile's texels with their border, and their halvings down to 1 x 1 (tile_pixels.hpp).
/// Immutable: shared between the store and those who draw from it.
struct TilePixels {
  std::vector<Image> levels;           ///< kGrey8: 1 channel; kRgb8: RGB and validity as alpha
  std::vector<Image16> linear_levels;  ///< kGreyLinear, kRgbLinear likewise; 65535 = 1.0
  /// Validity, an eighth of the tile's texels a side; empty where all are valid.
  Image valid;

  [[nodiscard]] std::size_t bytes() const;
  /// True where there is imagery. @param u, v  in the tile with its border, in [0, 1]
  [[nodiscard]] bool has_imagery(double u, double v) const;
};

/// A tile in a format, with its mip levels.
[[nodiscard]] TilePixels tile_pixels_from(const terrain::Tile& tile, PixelFormat format);

struct TileStoreOptions {
  std::size_t budget_bytes = std::size_t{512} << 20U;
  int threads = 1;  ///< that fetch ahead; 0 = none, everything is read when it is asked for
};

/// What the store has done so far.
struct TileStoreCounts {
  std::int64_t read_on_demand = 0;  ///< tiles that a `get` had to wait for
  std::int64_t read_ahead = 0;      ///< tiles that the store's threads read
  std::int64_t let_go = 0;          ///< tiles dropped to keep the budget
  double ahead_cpu_s = 0.0;         ///< CPU time of the store's threads
};

/// Thread-safe. Which tiles are in memory never changes a value that `get` returns.
class TileStore {
 public:
  TileStore(std::shared_ptr<const terrain::TileSource> tiles, const TileStoreOptions& options);
  ~TileStore();
  TileStore(const TileStore&) = delete;
  TileStore& operator=(const TileStore&) = delete;

  /// The tile, read now if it is not there. Errors: kIo naming the tile, when it cannot be read.
  [[nodiscard]] Result<std::shared_ptr<const TilePixels>> get(const terrain::TileId& id,
                                                              PixelFormat format);
  /// The tile if it is there, else null, and the tile is asked for (without threads: read).
  [[nodiscard]] std::shared_ptr<const TilePixels> find(const terrain::TileId& id,
                                                       PixelFormat format);
  /// The tile if it is there, else null.
  [[nodiscard]] std::shared_ptr<const TilePixels> peek(const terrain::TileId& id,
                                                       PixelFormat format);
  /// Asks for tiles that will be needed, the most urgent first; replaces what was asked before.
  /// What was used since the last call but one is not dropped to make room for them.
  void prefetch(std::span<const terrain::TileId> ids, PixelFormat format);
  /// Waits until the threads have nothing left to do.
  void wait_until_idle();

  /// Bytes of the tiles kept here; tiles that others still hold and the store let go do not count.
  [[nodiscard]] std::size_t held_bytes() const;
  [[nodiscard]] TileStoreCounts counts() const;
  [[nodiscard]] const terrain::TileSource& tiles() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace overfly::renderer
