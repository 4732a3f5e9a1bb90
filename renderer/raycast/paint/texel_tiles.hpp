// A cache of packed tiles of recent frames, within a budget.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "renderer/raycast/paint/packed_tile.hpp"
#include "renderer/tiles/tile_store.hpp"

namespace overfly::renderer::raycast {

/// The tile found for a request: itself, or a coarser one that covers it.
struct FoundTile {
  std::shared_ptr<const PackedTile> texels;
  terrain::TileId id;
};

class TexelTiles {
 public:
  TexelTiles(std::shared_ptr<TileStore> store, std::size_t budget_bytes);

  /// Reads those that are not in memory, several at once, as TileStore::load. Errors are reported
  /// by get().
  void load(const std::vector<terrain::TileId>& ids, PixelFormat format, std::int64_t limit_ns);
  /// The tile itself, read if needed. Errors: kIo naming the tile.
  [[nodiscard]] Result<FoundTile> get(const terrain::TileId& id, PixelFormat format);
  /// The best tile available now: the tile, or the nearest coarser one; a missing tile is
  /// requested. Waits for the coarsest one if there is no other. Errors: kIo.
  [[nodiscard]] Result<FoundTile> find(const terrain::TileId& id, PixelFormat format);
  /// Requests tiles for later frames, and packs one that is available.
  /// @return true if it packed one
  bool prefetch(const std::vector<terrain::TileId>& ids, PixelFormat format);
  /// Evicts the least recently used tiles until an eighth of the budget is free for tiles packed
  /// ahead of the next frames. Call between frames.
  void trim();

 private:
  using Key = std::pair<terrain::TileId, PixelFormat>;
  using Order = std::list<Key>;  // last used first
  struct Entry {
    std::shared_ptr<const PackedTile> texels;
    Order::iterator place;
  };
  [[nodiscard]] std::vector<terrain::TileId> missing_of(const std::vector<terrain::TileId>& ids,
                                                        PixelFormat format) const;
  std::shared_ptr<const PackedTile> held(const Key& key);
  std::shared_ptr<const PackedTile> keep(const Key& key, const TilePixels& pixels);

  std::shared_ptr<TileStore> store_;
  std::size_t budget_bytes_;
  std::size_t held_bytes_ = 0;
  Order order_;
  std::map<Key, Entry> entries_;
};

}  // namespace overfly::renderer::raycast
