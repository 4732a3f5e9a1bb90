// The tiles of a world as one run or viewer reads them; records which ones could not be read.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "terrain/decoration/tile_decorator.hpp"

namespace overfly::server {

/// Forwards all calls. Thread-safe.
class WatchedTiles final : public terrain::TileDecorator {
 public:
  /// @param cancel  ends the reading of a tile; may be null, must outlive the tiles
  WatchedTiles(std::shared_ptr<const terrain::TileSource> base, const std::atomic<bool>* cancel)
      : TileDecorator(std::move(base)), cancel_(cancel) {}

  /// The error of a tile whose latest read failed, if there is one.
  [[nodiscard]] Status unread() const;

 private:
  [[nodiscard]] Result<terrain::Tile> read_tile(const terrain::TileId& id,
                                                const terrain::Cancelled& cancelled) const override;

  const std::atomic<bool>* cancel_;
  mutable std::mutex mutex_;
  mutable std::map<terrain::TileId, Error> unread_;
};

}  // namespace overfly::server
