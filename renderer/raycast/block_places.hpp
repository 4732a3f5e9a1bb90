// Assigns to blocks of pixels the tiles that provide their texels.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "renderer/raycast/paint/blocks.hpp"

namespace overfly::renderer::raycast {

/// Number of mip levels for which a tile's border of 8 texels avoids seams, including level 0.
inline constexpr int kTileMips = 4;

/// The level of detail by OpenGL's rule: log2 of the longer of the two texel steps of one pixel to
/// the right and one pixel down (OpenGL 4.5, eq. 8.7 and 8.8).
[[nodiscard]] inline double texel_lod(double u_x, double v_x, double u_y, double v_y) {
  const double squared = std::max(u_x * u_x + v_x * v_x, u_y * u_y + v_y * v_y);
  return 0.5 * std::log2(std::max(squared, 1e-30));
}

/// Assigns tiles to ground blocks, divides blocks that no tile contains completely, and adds them
/// to the band. A tile fits a block if its texels are not larger than the block's finest level of
/// detail requires, and if it contains the block's texels at that level and the coarser ones.
class BlockPlaces {
 public:
  BlockPlaces(const terrain::TileSource& tiles, Band& band);
  void add(const Block& block);

 private:
  struct Extent {
    double low_u, high_u, low_v, high_v;
    float low_lod, high_lod;
  };
  [[nodiscard]] static Extent extent_of(const Block& block);
  /// True if a tile of this level on which a part of the extent lies has imagery.
  [[nodiscard]] bool meets_imagery(const Extent& extent, int level) const;
  /// Index in the band's list of tiles, or -1 if the tile has no imagery.
  std::int32_t index_of(const terrain::TileId& id);
  void divide(const Block& block);

  const terrain::TileSource& tiles_;
  Band& band_;
  std::vector<bool> has_imagery_;  // by the band's list
  std::int32_t last_ = -1;
};

}  // namespace overfly::renderer::raycast
