#include <algorithm>
#include <array>
#include <cmath>

#include "terrain/decoration/light.hpp"
#include "terrain/decoration/light_field.hpp"
#include "terrain/decoration/tile_decorator.hpp"
#include "terrain/floor_div.hpp"
#include "terrain/height_errors.hpp"

namespace overfly::terrain {
namespace {

/// Scales sRGB values in linear light (IEC 61966-2-1).
class SrgbScale {
 public:
  SrgbScale() {
    for (int i = 0; i < 256; ++i) {
      const double v = i / 255.0;
      linear_[i] = static_cast<float>(
          kLast * (v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4)));
    }
    for (int i = 0; i <= kLast; ++i) {
      const double v = static_cast<double>(i) / kLast;
      const double encoded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
      encoded_[i] = static_cast<std::uint8_t>(std::lround(255.0 * encoded));
    }
  }

  [[nodiscard]] std::uint8_t operator()(std::uint8_t value, float factor) const {
    const float scaled = linear_[value] * factor + 0.5F;
    return encoded_[static_cast<int>(std::min(scaled, static_cast<float>(kLast)))];
  }

 private:
  static constexpr int kLast = 32767;  ///< fine enough to resolve the darkest values
  std::array<float, 256> linear_{};
  std::array<std::uint8_t, kLast + 1> encoded_{};
};

/// Distance of the light's nodes at level 0: finer than typical posts, and coarse enough to be
/// fast. A power of two of texels.
double light_spacing_m(const TileSource& tiles) {
  constexpr double kCoarsestM = 6.0;
  for (const double texels : {8.0, 4.0}) {
    if (texels * tiles.real_texel_m() <= kCoarsestM) return texels * tiles.real_texel_m();
  }
  return 2.0 * tiles.real_texel_m();
}

class LitTiles final : public TileDecorator {
 public:
  LitTiles(const std::shared_ptr<const TileSource>& base, const LightOptions& options)
      : TileDecorator(base), field_(base, options, light_spacing_m(*base)) {}

 private:
  [[nodiscard]] Result<Tile> read_tile(const TileId& id,
                                       const Cancelled& cancelled) const override {
    auto read = base().tile(id, cancelled);
    if (!read) return read;
    const HeightErrors errors;
    if (id.level >= 0) shine(id, *read);
    if (Status heights = errors.status(); !heights) return heights.error();
    return read;
  }

  /// A texel's position between the nodes of one axis.
  struct Between {
    int node = 0;  ///< before the texel's centre, from the first
    float share = 0.0F;
  };
  /// @param first  the tile's first texel, from the grid's corner
  static std::array<Between, kTileSide> between_nodes(int first, int texels, int first_node) {
    std::array<Between, kTileSide> places;
    for (int k = 0; k < kTileSide; ++k) {
      const int node = floor_div(first + k, texels);
      // Node n lies at the west edge of texel n * texels; texel centres half a texel further.
      const auto inside = static_cast<float>(first + k - node * texels);
      places[k] = {node - first_node, (inside + 0.5F) / static_cast<float>(texels)};
    }
    return places;
  }

  void shine(const TileId& id, Tile& tile) const {
    const double texel_m = grid().texel_m * (1 << id.level);
    int lattice = 0;
    while (field_.spacing_m(lattice) < 1.999 * texel_m) ++lattice;
    const int texels = static_cast<int>(std::lround(field_.spacing_m(lattice) / texel_m));
    const int first_x = id.col * kTileTexels - kTileBorder;
    const int first_y = id.row * kTileTexels - kTileBorder;
    const int i = floor_div(first_x, texels);
    const int j = floor_div(first_y, texels);
    const auto columns = between_nodes(first_x, texels, i);
    const auto rows = between_nodes(first_y, texels, j);
    const ImageBuffer<float> light =
        field_.nodes(lattice, i, j, columns.back().node + 2, rows.back().node + 2);
    for (int y = 0; y < kTileSide; ++y) {
      const auto [row, down] = rows[y];
      for (int x = 0; x < kTileSide; ++x) {
        const std::size_t at = static_cast<std::size_t>(y) * kTileSide + x;
        if (tile.valid.data[at] == 0) continue;
        const auto [column, across] = columns[x];
        const float* north = &light.at(column, row);
        const float* south = &light.at(column, row + 1);
        const float factor = (1.0F - down) * ((1.0F - across) * north[0] + across * north[1]) +
                             down * ((1.0F - across) * south[0] + across * south[1]);
        for (std::size_t c = 0; c < 3; ++c) {
          std::uint8_t& value = tile.rgb.data[3 * at + c];
          value = scale_(value, factor);
        }
      }
    }
  }

  LightField field_;
  SrgbScale scale_;
};

}  // namespace

Result<std::shared_ptr<const TileSource>> with_light(const std::shared_ptr<const TileSource>& tiles,
                                                     const LightOptions& options) {
  const Status valid = options.validate();
  if (!valid) return valid.error();
  return std::shared_ptr<const TileSource>(std::make_shared<LitTiles>(tiles, options));
}

}  // namespace overfly::terrain
