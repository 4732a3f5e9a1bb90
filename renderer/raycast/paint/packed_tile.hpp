// A tile's texels in the layout of the sampling kernels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/tiles/tile_store.hpp"

namespace overfly::renderer::raycast {

inline constexpr int kPackedMips = 8;

/// Texels in pairs: each element holds a texel in its low half and the one below it in its high
/// half, so that one load of two neighbouring elements gives all four texels of a bilinear sample.
struct PackedTile {
  int planes = 1;     ///< 1 = grey, 3 = red, green, blue
  bool wide = false;  ///< 16-bit texels in `wide_pairs`, else 8-bit ones in `pairs`
  std::size_t plane_elements = 0;
  std::vector<std::uint16_t> pairs;
  std::vector<std::uint32_t> wide_pairs;
  /// By mip level; mip levels that the tile lacks repeat the last one.
  std::array<std::int32_t, kPackedMips> offset{}, stride{};  ///< elements
  std::array<float, kPackedMips> scale_x{}, scale_y{};  ///< texels of this mip per texel of mip 0
  std::array<float, kPackedMips> last_x{}, last_y{};
  Image valid;  ///< as in TilePixels

  static PackedTile from(const TilePixels& pixels);
  [[nodiscard]] std::size_t bytes() const;
  /// True if there is imagery. @param u, v  texels of mip 0, from the border's corner
  [[nodiscard]] bool has_imagery(double u, double v) const;
};

}  // namespace overfly::renderer::raycast
