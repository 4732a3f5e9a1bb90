#include "renderer/egl/tile_textures.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "renderer/egl/texture_upload.hpp"
#include "renderer/tile_pixels.hpp"

namespace overfly::renderer::egl {

using terrain::TileId;

namespace {

constexpr int kValidStep = 8;

/// Grey, or RGB with the imagery's validity as alpha.
Image in_format(const terrain::Tile& tile, PixelFormat format) {
  return format == PixelFormat::kGrey8 ? grey_from_rgb(tile.rgb) : with_alpha(tile.rgb, tile.valid);
}

Image thinned(const Image& valid) {
  const bool all_valid =
      std::all_of(valid.data.begin(), valid.data.end(), [](auto value) { return value != 0; });
  if (all_valid) return {};
  Image thin(valid.width_px / kValidStep, valid.height_px / kValidStep, 1);
  for (int y = 0; y < thin.height_px; ++y) {
    for (int x = 0; x < thin.width_px; ++x) {
      thin.at(x, y) = valid.at(x * kValidStep + kValidStep / 2, y * kValidStep + kValidStep / 2);
    }
  }
  return thin;
}

}  // namespace

TileTextures::TileTextures(std::shared_ptr<const terrain::TileSource> tiles,
                           std::size_t budget_bytes)
    : tiles_(std::move(tiles)), budget_bytes_(budget_bytes) {}

Result<GLuint> TileTextures::texture(const TileId& id, PixelFormat format) {
  const Key key{id, format};
  if (const auto found = by_key_.find(key); found != by_key_.end()) {
    entries_.splice(entries_.begin(), entries_, found->second);
    return found->second->texture.name();
  }
  Result<terrain::Tile> tile = tiles_->tile(id);
  if (!tile.ok()) {
    return tile.error().in("tile " + std::to_string(id.level) + "/" + std::to_string(id.col) + "/" +
                           std::to_string(id.row));
  }
  Entry entry;
  entry.key = key;
  entry.valid = thinned(tile->valid);
  const std::vector<Image> levels = mip_chain(in_format(*tile, format));
  for (const Image& level : levels) entry.bytes += level.data.size();
  entry.texture = upload_texture(levels);
  held_bytes_ += entry.bytes;
  entries_.push_front(std::move(entry));
  by_key_.emplace(key, entries_.begin());
  return entries_.front().texture.name();
}

GLuint TileTextures::void_texture(PixelFormat format) {
  GlTexture& texture = format == PixelFormat::kGrey8 ? void_grey_ : void_rgb_;
  if (texture.name() == 0) {
    terrain::Tile nothing{Image(1, 1, 3), Image(1, 1, 1)};
    std::copy(std::begin(terrain::kVoidRgb), std::end(terrain::kVoidRgb), nothing.rgb.data.begin());
    texture = upload_texture({in_format(nothing, format)});
  }
  return texture.name();
}

bool TileTextures::has_imagery(const TileId& id, PixelFormat format, double u, double v) {
  const auto found = by_key_.find({id, format});
  if (found == by_key_.end()) return false;
  const Image& valid = found->second->valid;
  if (valid.empty()) return true;
  const int x = std::clamp(static_cast<int>(u * valid.width_px), 0, valid.width_px - 1);
  const int y = std::clamp(static_cast<int>(v * valid.height_px), 0, valid.height_px - 1);
  return valid.at(x, y) != 0;
}

void TileTextures::end_view() {
  // Called after a view is drawn: the newest entries are that view's, so that a budget smaller
  // than one view still leaves nothing of older ones.
  while (held_bytes_ > budget_bytes_ && !entries_.empty()) {
    held_bytes_ -= entries_.back().bytes;
    by_key_.erase(entries_.back().key);
    entries_.pop_back();
  }
}

}  // namespace overfly::renderer::egl
