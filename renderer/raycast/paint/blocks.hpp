// The hits of an image's rays as blocks of pixels. In a block the ground's place on the map is a
// fraction of two bilinear functions of the pixel, which is exact if the ground is a plane.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/raycast/cache_line.hpp"
#include "terrain/tile_source.hpp"

namespace overfly::renderer::raycast {

/// c[0] + c[1] x + c[2] y + c[3] x y, with pixels relative to the block's first pixel.
using Bilinear4 = std::array<float, 4>;

inline float value_at(const Bilinear4& f, float x, float y) {
  return f[0] + f[1] * x + (f[2] + f[3] * x) * y;
}

/// The function with its origin at (x, y).
inline Bilinear4 moved(const Bilinear4& f, float x, float y) {
  return {value_at(f, x, y), f[1] + f[3] * y, f[2] + f[3] * x, f[3]};
}

struct Block {
  enum class Kind : std::uint8_t { kGround, kVoid, kSky };

  std::uint16_t x = 0, y = 0;  ///< first pixel
  std::uint8_t columns = 0, rows = 0;
  Kind kind = Kind::kSky;
  bool quarter = false;     ///< one of four successive blocks that form a single pixel
  std::int32_t tile = -1;   ///< index in the band's list
  double u = 0.0, v = 0.0;  ///< map origin of the numerators, texels of level 0
  Bilinear4 numerator_u{}, numerator_v{};  ///< (u - u_0) * inverse depth [texels / m]
  Bilinear4 inverse_depth{};               ///< [1 / m]
  /// log2 of the texels of level 0 between samples (OpenGL 4.5, section 8.14.1).
  Bilinear4 lod{};
  Bilinear4 clear{};  ///< transmission of the air, 1 in a vacuum
};

/// The blocks of one row of cells, from left to right, and their tiles.
struct alignas(kCacheLineBytes) Band {
  std::vector<Block> blocks;
  std::vector<terrain::TileId> tiles;
};

}  // namespace overfly::renderer::raycast
