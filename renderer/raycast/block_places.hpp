// Which tile a block of pixels takes its texels from.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "renderer/raycast/paint/blocks.hpp"

namespace overfly::renderer::raycast {

/// Mip levels of a tile that its border of 8 texels keeps free of seams, its own texels included.
inline constexpr int kTileMips = 4;

/// The level of detail that OpenGL's rule gives: log2 of the longer of the two steps that a pixel
/// to the right and a pixel down make on the texture, in texels (OpenGL 4.5, eq. 8.7 and 8.8).
[[nodiscard]] inline double texel_lod(double u_x, double v_x, double u_y, double v_y) {
  const double squared = std::max(u_x * u_x + v_x * v_x, u_y * u_y + v_y * v_y);
  return 0.5 * std::log2(std::max(squared, 1e-30));
}

/// Gives ground blocks their tiles, dividing those that lie in none as a whole, and adds them to
/// the band. A tile serves a block when its texels are no larger than the block's finest level of
/// detail asks, and it holds the block's texels at that level and the coarser ones.
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
  /// The tile of the band's list, or -1 when it has no imagery.
  std::int32_t index_of(const terrain::TileId& id);
  void divide(const Block& block);

  const terrain::TileSource& tiles_;
  Band& band_;
  std::vector<bool> has_imagery_;  // by the band's list
  std::int32_t last_ = -1;
};

}  // namespace overfly::renderer::raycast
