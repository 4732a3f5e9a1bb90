#include "server/camera/watched_tiles.hpp"

namespace overfly::engine {

Result<terrain::Tile> WatchedTiles::tile(const terrain::TileId& id) const {
  Result<terrain::Tile> read = TileDecorator::tile(id);
  const std::lock_guard lock(mutex_);
  if (read) {
    unread_.erase(id);
  } else {
    unread_.insert_or_assign(id, read.error());
  }
  return read;
}

Status WatchedTiles::unread() const {
  const std::lock_guard lock(mutex_);
  return unread_.empty() ? Status() : Status(unread_.begin()->second);
}

}  // namespace overfly::engine
