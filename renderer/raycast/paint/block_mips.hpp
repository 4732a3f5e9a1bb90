// The mip levels that the pixels of a block use, for kernels that treat the usual cases apart.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "renderer/raycast/paint/sample.hpp"

namespace overfly::renderer::raycast {

/// The mip levels used by a block's pixels. The scales of all but `kAny` are powers of two.
enum class Mips {
  kFirst,  ///< all only the first one
  kTwo,    ///< all the same two
  kAny,
};

/// Values common to a whole block.
struct BlockMips {
  Mips mips = Mips::kAny;
  int first = 0;  ///< of kTwo
};

/// Rounding changes a level of detail by far less than this.
inline constexpr float kLodSlack = 1e-3F;

/// Whether the scales of a mip level are powers of two.
inline bool exact_scale(const PackedTile& tile, int mip) {
  constexpr std::uint32_t kFraction = (1U << 23U) - 1U;
  return ((std::bit_cast<std::uint32_t>(tile.scale_x[mip]) |
           std::bit_cast<std::uint32_t>(tile.scale_y[mip])) &
          kFraction) == 0;
}

inline BlockMips mips_of(const TexelBlock& block, const PackedTile& tile) {
  const auto x = static_cast<float>(block.columns - 1);
  const auto y = static_cast<float>(block.rows - 1);
  const Bilinear4& f = block.lod;
  const float east = f[0] + f[1] * x;
  const float south = f[0] + f[2] * y;
  const float both = east + (f[2] + f[3] * x) * y;
  const float low = std::min(std::min(f[0], east), std::min(south, both)) - kLodSlack;
  const float high = std::max(std::max(f[0], east), std::max(south, both)) + kLodSlack;
  if (high <= 0.0F && exact_scale(tile, 0)) return {Mips::kFirst, 0};
  if (!(low > 0.0F && high < static_cast<float>(kPackedMips - 1))) return {};
  const int first = static_cast<int>(low);
  const bool two =
      first == static_cast<int>(high) && exact_scale(tile, first) && exact_scale(tile, first + 1);
  return two ? BlockMips{Mips::kTwo, first} : BlockMips{};
}

}  // namespace overfly::renderer::raycast
