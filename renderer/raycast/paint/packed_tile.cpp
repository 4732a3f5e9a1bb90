#include "renderer/raycast/paint/packed_tile.hpp"

#include <algorithm>

namespace overfly::renderer::raycast {

namespace {

constexpr double kSide = terrain::kTileSide;

template <typename Texel, typename Pair>
void pack(PackedTile& tile, const std::vector<ImageBuffer<Texel>>& levels, std::vector<Pair>& to) {
  tile.planes = levels.front().channels == 1 ? 1 : 3;
  const int mips = std::min<int>(kPackedMips, static_cast<int>(levels.size()));
  std::size_t elements = 0;
  for (int m = 0; m < kPackedMips; ++m) {
    const ImageBuffer<Texel>& level = levels[std::min(m, mips - 1)];
    const auto width = static_cast<float>(level.width_px);
    const auto height = static_cast<float>(level.height_px);
    tile.stride[m] = level.width_px;
    tile.scale_x[m] = width / static_cast<float>(levels.front().width_px);
    tile.scale_y[m] = height / static_cast<float>(levels.front().height_px);
    tile.last_x[m] = width - 1.0F;
    tile.last_y[m] = height - 1.0F;
    if (m >= mips) {
      tile.offset[m] = tile.offset[mips - 1];
      continue;
    }
    tile.offset[m] = static_cast<std::int32_t>(elements);
    elements += static_cast<std::size_t>(level.width_px) * level.height_px;
  }
  // The right neighbour of the last texel is read too, with weight zero.
  tile.plane_elements = elements + 2;
  to.resize(tile.plane_elements * tile.planes);
  for (int m = 0; m < mips; ++m) {
    const ImageBuffer<Texel>& level = levels[m];
    for (int plane = 0; plane < tile.planes; ++plane) {
      Pair* out = &to[plane * tile.plane_elements + tile.offset[m]];
      for (int y = 0; y < level.height_px; ++y) {
        const Texel* upper = &level.at(0, y, plane);
        const Texel* lower = &level.at(0, std::min(y + 1, level.height_px - 1), plane);
        for (int x = 0; x < level.width_px; ++x) {
          *out++ = static_cast<Pair>(upper[x * level.channels] |
                                     static_cast<Pair>(lower[x * level.channels])
                                         << (8 * sizeof(Texel)));
        }
      }
    }
  }
}

}  // namespace

PackedTile PackedTile::from(const TilePixels& pixels) {
  PackedTile tile;
  tile.wide = pixels.levels.empty();
  if (tile.wide) {
    pack(tile, pixels.linear_levels, tile.wide_pairs);
  } else {
    pack(tile, pixels.levels, tile.pairs);
  }
  tile.valid = pixels.valid;
  return tile;
}

std::size_t PackedTile::bytes() const {
  return pairs.size() * sizeof(pairs[0]) + wide_pairs.size() * sizeof(wide_pairs[0]) +
         valid.data.size();
}

bool PackedTile::has_imagery(double u, double v) const {
  if (valid.empty()) return true;
  const int x = std::clamp(static_cast<int>(u / kSide * valid.width_px), 0, valid.width_px - 1);
  const int y = std::clamp(static_cast<int>(v / kSide * valid.height_px), 0, valid.height_px - 1);
  return valid.at(x, y) != 0;
}

}  // namespace overfly::renderer::raycast
