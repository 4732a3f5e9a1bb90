#include "renderer/egl/tile_textures.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "renderer/egl/texture_upload.hpp"

namespace overfly::renderer::egl {

using terrain::TileId;

namespace {

/// Position of a tile in its ancestor `steps` levels up, in texture coordinates with borders.
DrawnTile window_in(const TileId& id, int steps) {
  constexpr double kSide = terrain::kTileTexels + 2.0 * terrain::kTileBorder;
  const double scale = std::ldexp(1.0, -steps);
  const auto offset = [&](int place) {
    const int within = place - ((place >> steps) * (1 << steps));
    return static_cast<float>(
        (terrain::kTileBorder * (1.0 - scale) + within * scale * terrain::kTileTexels) / kSide);
  };
  return {0, static_cast<float>(scale), {offset(id.col), offset(id.row)}};
}

}  // namespace

TileTextures::TileTextures(std::shared_ptr<TileStore> store, std::size_t budget_bytes)
    : store_(std::move(store)), budget_bytes_(budget_bytes) {}

TileTextures::Entry* TileTextures::find(const Key& key) {
  const auto found = by_key_.find(key);
  if (found == by_key_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found->second);
  return &*found->second;
}

TileTextures::Entry& TileTextures::upload(const Key& key, const TilePixels& pixels) {
  Entry entry;
  entry.key = key;
  entry.valid = pixels.valid;
  entry.bytes = pixels.bytes();
  entry.texture = upload_texture(pixels);
  held_bytes_ += entry.bytes;
  entries_.push_front(std::move(entry));
  by_key_.emplace(key, entries_.begin());
  return entries_.front();
}

void TileTextures::load(const std::vector<TileId>& ids, PixelFormat format, std::int64_t limit_ns) {
  std::vector<TileId> missing;
  std::copy_if(ids.begin(), ids.end(), std::back_inserter(missing), [&](const TileId& id) {
    return by_key_.count({id, format}) == 0;
  });
  if (!missing.empty()) store_->load(missing, format, limit_ns);
}

Result<DrawnTile> TileTextures::texture(const TileId& id, PixelFormat format, bool wait) {
  const Key key{id, format};
  if (const Entry* entry = find(key); entry != nullptr) return DrawnTile{entry->texture.name()};
  if (!wait) {
    const std::shared_ptr<const TilePixels> pixels = store_->find(id, format);
    return pixels != nullptr ? DrawnTile{upload(key, *pixels).texture.name()} : coarser(key);
  }
  const auto pixels = store_->get(id, format);
  if (!pixels.ok()) return pixels.error();
  return DrawnTile{upload(key, **pixels).texture.name()};
}

Result<DrawnTile> TileTextures::coarser(const Key& key) {
  const auto& [id, format] = key;
  const int coarsest = std::max(store_->tiles().grid().levels - 1, id.level);
  for (int level = id.level + 1; level <= coarsest; ++level) {
    const int steps = level - id.level;
    const Key above{{level, id.col >> steps, id.row >> steps}, format};
    const Entry* entry = find(above);
    if (entry == nullptr) {
      std::shared_ptr<const TilePixels> pixels = store_->peek(above.first, format);
      if (pixels == nullptr && level == coarsest) {
        // No tile is available: wait for the one tile that covers the world.
        auto read = store_->get(above.first, format);
        if (!read.ok()) return read.error();
        pixels = *read;
      }
      if (pixels == nullptr) continue;
      entry = &upload(above, *pixels);
    }
    DrawnTile drawn = window_in(id, steps);
    drawn.texture = entry->texture.name();
    late_.insert_or_assign(key, Substitute{above.first, drawn});
    return drawn;
  }
  auto read = store_->get(id, format);
  if (!read.ok()) return read.error();
  return DrawnTile{upload(key, **read).texture.name()};
}

GLuint TileTextures::void_texture(PixelFormat format) {
  GlTexture& texture = void_[format];
  if (texture.name() == 0) {
    terrain::Tile nothing{Image(1, 1, 3), Image(1, 1, 1)};
    std::copy(std::begin(terrain::kVoidRgb), std::end(terrain::kVoidRgb), nothing.rgb.data.begin());
    texture = upload_texture(tile_pixels_from(nothing, format));
  }
  return texture.name();
}

bool TileTextures::has_imagery(const TileId& id, PixelFormat format, double u, double v) {
  Key key{id, format};
  if (const auto late = late_.find(key); late != late_.end()) {
    const DrawnTile& drawn = late->second.drawn;
    u = drawn.scale * u + drawn.offset[0];
    v = drawn.scale * v + drawn.offset[1];
    key.first = late->second.id;
  }
  const auto found = by_key_.find(key);
  if (found == by_key_.end()) return false;
  const Image& valid = found->second->valid;
  if (valid.empty()) return true;
  const int x = std::clamp(static_cast<int>(u * valid.width_px), 0, valid.width_px - 1);
  const int y = std::clamp(static_cast<int>(v * valid.height_px), 0, valid.height_px - 1);
  return valid.at(x, y) != 0;
}

int TileTextures::end_view() {
  // Called after a view is drawn: the newest entries belong to that view, so a budget smaller than
  // one view still evicts all older ones.
  while (held_bytes_ > budget_bytes_ && !entries_.empty()) {
    held_bytes_ -= entries_.back().bytes;
    by_key_.erase(entries_.back().key);
    entries_.pop_back();
  }
  const int late = static_cast<int>(late_.size());
  late_.clear();
  return late;
}

}  // namespace overfly::renderer::egl
