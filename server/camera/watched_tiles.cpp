#include "server/camera/watched_tiles.hpp"

#include "core/cancel.hpp"

namespace overfly::server {

Result<terrain::Tile> WatchedTiles::read_tile(const terrain::TileId& id,
                                              const terrain::Cancelled& cancelled) const {
  if (Status heights = status(); !heights) return heights.error();
  Result<terrain::Tile> read = watched([&] {
    return base().tile(id, [&] { return is_cancelled(cancel_) || (cancelled && cancelled()); });
  });
  const std::lock_guard lock(mutex_);
  if (read) {
    unread_.erase(id);
  } else {
    unread_.insert_or_assign(id, read.error());
  }
  return read;
}

void WatchedTiles::keep(const Error& error) const {
  const std::lock_guard lock(mutex_);
  if (!unread_height_) unread_height_ = error;
}

Status WatchedTiles::status() const {
  const std::lock_guard lock(mutex_);
  return unread_height_ ? Status(*unread_height_) : Status();
}

Status WatchedTiles::unread() const {
  const std::lock_guard lock(mutex_);
  return unread_.empty() ? Status() : Status(unread_.begin()->second);
}

}  // namespace overfly::server
