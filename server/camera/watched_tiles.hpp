// The tiles of a world as one run reads them, and which of them could not be read.
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "terrain/tile_decorator.hpp"

namespace overfly::engine {

/// Passes everything on. Thread-safe.
class WatchedTiles final : public terrain::TileDecorator {
 public:
  using TileDecorator::TileDecorator;

  [[nodiscard]] Result<terrain::Tile> tile(const terrain::TileId& id) const override;
  /// The error of a tile that could not be read when it was asked for last, if there is one.
  [[nodiscard]] Status unread() const;

 private:
  mutable std::mutex mutex_;
  mutable std::map<terrain::TileId, Error> unread_;
};

}  // namespace overfly::engine
