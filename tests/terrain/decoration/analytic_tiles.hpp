// Ground that is a formula under imagery that is another: what layers over tiles are tested on.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "terrain/tile_source.hpp"

namespace overfly::testing {

/// East is x_map, north is y_map; the map's corner lies in the north-west.
class AnalyticTiles final : public terrain::TileSource {
 public:
  using Height = std::function<double(double east_m, double north_m)>;
  /// Grey value of a texel of level 0, by its column and row from the corner.
  using Texel = std::function<int(int column, int row)>;

  AnalyticTiles(double texel_m, int tiles, Height height, Eigen::Vector2d range_m, Texel texel)
      : height_(std::move(height)), texel_(std::move(texel)), range_m_(range_m) {
    grid_.texel_m = texel_m;
    grid_.cols = tiles;
    grid_.rows = tiles;
    while ((1 << (grid_.levels - 1)) < tiles) ++grid_.levels;
    grid_.width_m = tiles * grid_.tile_m(0);
    grid_.height_m = grid_.width_m;
  }

  [[nodiscard]] const terrain::TileGrid& grid() const override { return grid_; }
  [[nodiscard]] terrain::TileCoverage coverage(const terrain::TileId& id) const override {
    const int across = (grid_.cols + (1 << id.level) - 1) >> id.level;
    const bool inside = id.col >= 0 && id.row >= 0 && id.col < across && id.row < across;
    return inside ? terrain::TileCoverage::kPartial : terrain::TileCoverage::kNone;
  }
  /// Of coarser levels the texel in the middle stands for all: enough where texels are constant.
  [[nodiscard]] Result<terrain::Tile> read_tile(
      const terrain::TileId& id, const terrain::Cancelled& /*cancelled*/) const override {
    terrain::Tile tile{Image(terrain::kTileSide, terrain::kTileSide, 3),
                       Image(terrain::kTileSide, terrain::kTileSide, 1)};
    const int last = grid_.cols * terrain::kTileTexels;
    for (int y = 0; y < terrain::kTileSide; ++y) {
      for (int x = 0; x < terrain::kTileSide; ++x) {
        const int column =
            (id.col * terrain::kTileTexels + x - terrain::kTileBorder) * (1 << id.level);
        const int row =
            (id.row * terrain::kTileTexels + y - terrain::kTileBorder) * (1 << id.level);
        const bool inside = column >= 0 && row >= 0 && column < last && row < last;
        tile.valid.at(x, y) = inside ? 255 : 0;
        const int half = (1 << id.level) / 2;
        for (int c = 0; c < 3; ++c) {
          tile.rgb.at(x, y, c) = inside
                                     ? static_cast<std::uint8_t>(texel_(column + half, row + half))
                                     : terrain::kVoidRgb[c];
        }
      }
    }
    return tile;
  }
  [[nodiscard]] Eigen::Vector3d world_from_map(double x_map_m, double y_map_m) const override {
    return {x_map_m, y_map_m, height_(x_map_m, y_map_m)};
  }
  [[nodiscard]] Eigen::Vector2d map_from_world(double east_m, double north_m) const override {
    return {east_m, north_m};
  }
  [[nodiscard]] double ground_up_m(double east_m, double north_m) const override {
    return height_(east_m, north_m);
  }
  [[nodiscard]] bool has_imagery(double x_map_m, double y_map_m) const override {
    return x_map_m >= 0.0 && y_map_m <= 0.0 && x_map_m < grid_.width_m && y_map_m > -grid_.height_m;
  }
  [[nodiscard]] const LocalFrame& frame() const override { return frame_; }
  [[nodiscard]] Eigen::Vector2d height_range_m() const override { return range_m_; }
  [[nodiscard]] std::string attribution() const override { return "analytic"; }

 private:
  terrain::TileGrid grid_;
  Height height_;
  Texel texel_;
  Eigen::Vector2d range_m_;
  LocalFrame frame_{Geodetic{}};
};

}  // namespace overfly::testing
