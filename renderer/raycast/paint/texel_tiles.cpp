#include "renderer/raycast/paint/texel_tiles.hpp"

#include <algorithm>
#include <iterator>

namespace overfly::renderer::raycast {

using terrain::TileId;

TexelTiles::TexelTiles(std::shared_ptr<TileStore> store, std::size_t budget_bytes)
    : store_(std::move(store)), budget_bytes_(budget_bytes) {}

std::shared_ptr<const PackedTile> TexelTiles::held(const Key& key) {
  const auto found = entries_.find(key);
  if (found == entries_.end()) return nullptr;
  order_.splice(order_.begin(), order_, found->second.place);
  return found->second.texels;
}

std::shared_ptr<const PackedTile> TexelTiles::keep(const Key& key, const TilePixels& pixels) {
  auto texels = std::make_shared<const PackedTile>(PackedTile::from(pixels));
  Order place{key};
  entries_.emplace(key, Entry{texels, place.begin()});
  order_.splice(order_.begin(), place);
  held_bytes_ += texels->bytes();
  return texels;
}

std::vector<TileId> TexelTiles::missing_of(const std::vector<TileId>& ids,
                                           PixelFormat format) const {
  std::vector<TileId> missing;
  std::copy_if(ids.begin(), ids.end(), std::back_inserter(missing), [&](const TileId& id) {
    return entries_.count({id, format}) == 0;
  });
  return missing;
}

void TexelTiles::load(const std::vector<TileId>& ids, PixelFormat format, std::int64_t limit_ns) {
  const std::vector<TileId> missing = missing_of(ids, format);
  if (!missing.empty()) store_->load(missing, format, limit_ns);
}

Result<FoundTile> TexelTiles::get(const TileId& id, PixelFormat format) {
  const Key key{id, format};
  if (auto texels = held(key)) return FoundTile{std::move(texels), id};
  const Result<std::shared_ptr<const TilePixels>> pixels = store_->get(id, format);
  if (!pixels.ok()) return pixels.error();
  return FoundTile{keep(key, **pixels), id};
}

Result<FoundTile> TexelTiles::find(const TileId& id, PixelFormat format) {
  if (auto texels = held({id, format})) return FoundTile{std::move(texels), id};
  if (const auto pixels = store_->find(id, format)) {
    return FoundTile{keep({id, format}, *pixels), id};
  }
  const int levels = store_->tiles().grid().levels;
  TileId coarser = id;
  while (coarser.level + 1 < levels) {
    coarser = {coarser.level + 1, coarser.col >> 1, coarser.row >> 1};
    if (auto texels = held({coarser, format})) return FoundTile{std::move(texels), coarser};
    if (const auto pixels = store_->peek(coarser, format)) {
      return FoundTile{keep({coarser, format}, *pixels), coarser};
    }
  }
  return get(coarser, format);
}

bool TexelTiles::prefetch(const std::vector<TileId>& ids, PixelFormat format) {
  const std::vector<TileId> missing = missing_of(ids, format);
  store_->prefetch(missing, format);
  // One per frame, so that a row of tiles that comes into view does not slow down a single frame.
  for (const TileId& id : missing) {
    const auto pixels = store_->peek(id, format);
    if (pixels == nullptr) continue;
    if (held_bytes_ + 2 * pixels->bytes() >= budget_bytes_) return false;
    (void)keep({id, format}, *pixels);
    return true;
  }
  return false;
}

void TexelTiles::trim() {
  const std::size_t most_bytes = budget_bytes_ - budget_bytes_ / 8;
  while (held_bytes_ > most_bytes && !order_.empty()) {
    const auto oldest = entries_.find(order_.back());
    held_bytes_ -= oldest->second.texels->bytes();
    entries_.erase(oldest);
    order_.pop_back();
  }
}

}  // namespace overfly::renderer::raycast
