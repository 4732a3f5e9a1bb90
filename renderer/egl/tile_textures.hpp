// Tiles on the GPU.
#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <utility>

#include "core/result.hpp"
#include "renderer/egl/gl_objects.hpp"
#include "renderer/renderer.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::renderer::egl {

/// Loads tiles as textures with mip levels and keeps those used last within a budget. Tiles of
/// the view being drawn stay, even if they alone exceed it.
class TileTextures {
 public:
  TileTextures(std::shared_ptr<const terrain::TileSource> tiles, std::size_t budget_bytes);

  /// The texture of a tile, loaded if need be. Good until end_view().
  /// Errors: kIo when the tile cannot be read.
  Result<GLuint> texture(const terrain::TileId& id, PixelFormat format);
  /// A texture of the void's colour.
  GLuint void_texture(PixelFormat format);
  /// True where the tile has imagery. @pre its texture was asked for in this view
  [[nodiscard]] bool has_imagery(const terrain::TileId& id, PixelFormat format, double u, double v);
  /// Lets the textures used longest ago go until the budget holds.
  void end_view();

  [[nodiscard]] std::size_t held_bytes() const { return held_bytes_; }

 private:
  using Key = std::pair<terrain::TileId, PixelFormat>;
  struct Entry {
    Key key;
    GlTexture texture;
    Image valid;  // an eighth of the tile's texels a side; empty where all are valid
    std::size_t bytes = 0;
  };
  using Entries = std::list<Entry>;  // last used first

  std::shared_ptr<const terrain::TileSource> tiles_;
  std::size_t budget_bytes_;
  std::size_t held_bytes_ = 0;
  Entries entries_;
  std::map<Key, Entries::iterator> by_key_;
  GlTexture void_grey_, void_rgb_;
};

}  // namespace overfly::renderer::egl
