// The tiles of a world as one run reads them; records which ones could not be read.
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "terrain/decoration/tile_decorator.hpp"

namespace overfly::engine {

/// Forwards all calls. Thread-safe.
class WatchedTiles final : public terrain::TileDecorator {
 public:
  using TileDecorator::TileDecorator;

  [[nodiscard]] Result<terrain::Tile> tile(const terrain::TileId& id) const override;
  /// The error of a tile whose latest read failed, if there is one.
  [[nodiscard]] Status unread() const;

 private:
  mutable std::mutex mutex_;
  mutable std::map<terrain::TileId, Error> unread_;
};

}  // namespace overfly::engine
