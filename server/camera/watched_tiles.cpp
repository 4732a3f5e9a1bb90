#include "server/camera/watched_tiles.hpp"

#include "core/cancel.hpp"

namespace overfly::server {

Result<terrain::Tile> WatchedTiles::read_tile(const terrain::TileId& id,
                                              const terrain::Cancelled& cancelled) const {
  Result<terrain::Tile> read =
      base().tile(id, [&] { return is_cancelled(cancel_) || (cancelled && cancelled()); });
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

}  // namespace overfly::server
