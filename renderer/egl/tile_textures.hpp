// Tiles as textures on the GPU.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "core/result.hpp"
#include "renderer/egl/gl_objects.hpp"
#include "renderer/renderer.hpp"
#include "renderer/tiles/tile_store.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::renderer::egl {

/// A texture that shows a tile.
struct DrawnTile {
  GLuint texture = 0;
  /// Texture coordinates in it: scale * (u, v) + offset; (1, 0, 0) unless the tile was late.
  float scale = 1.0F;
  std::array<float, 2> offset{};
};

/// Uploads tiles of a store as textures and keeps the most recently used ones within a budget.
/// Tiles of the view being drawn are kept, even if they exceed it.
class TileTextures {
 public:
  TileTextures(std::shared_ptr<TileStore> store, std::size_t budget_bytes);

  /// Reads those that are not in memory, several at once, as TileStore::load. Errors are reported
  /// by texture().
  void load(const std::vector<terrain::TileId>& ids, PixelFormat format, std::int64_t limit_ns);
  /// The texture of a tile. Valid until end_view().
  /// @param wait  true: reads the tile if needed; false: uses the nearest available coarser tile
  /// Errors: kIo if a tile cannot be read.
  Result<DrawnTile> texture(const terrain::TileId& id, PixelFormat format, bool wait);
  /// A texture of the void's colour.
  GLuint void_texture(PixelFormat format);
  /// True if the tile has imagery there. @pre its texture was requested in this view
  [[nodiscard]] bool has_imagery(const terrain::TileId& id, PixelFormat format, double u, double v);
  /// Evicts the least recently used textures until the budget is met.
  /// @return number of late tiles of the view
  int end_view();

  [[nodiscard]] std::size_t held_bytes() const { return held_bytes_; }

 private:
  using Key = std::pair<terrain::TileId, PixelFormat>;
  struct Entry {
    Key key;
    GlTexture texture;
    Image valid;  // as TilePixels::valid
    std::size_t bytes = 0;
  };
  using Entries = std::list<Entry>;  // last used first
  struct Substitute {
    terrain::TileId id;  // the coarser tile
    DrawnTile drawn;
  };

  Entry* find(const Key& key);
  Entry& upload(const Key& key, const TilePixels& pixels);
  Result<DrawnTile> coarser(const Key& key);

  std::shared_ptr<TileStore> store_;
  std::size_t budget_bytes_;
  std::size_t held_bytes_ = 0;
  Entries entries_;
  std::map<Key, Entries::iterator> by_key_;
  std::map<Key, Substitute> late_;  // of this view
  std::map<PixelFormat, GlTexture> void_;
};

}  // namespace overfly::renderer::egl
