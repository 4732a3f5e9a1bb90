#include "server/report/figures/ground_picture.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "terrain/height_errors.hpp"

namespace overfly::server::report {
namespace {

using terrain::Tile;
using terrain::TileId;
using terrain::TileSource;

/// Places between which the map position is interpolated [px]. The map plane is a smooth function
/// of east and north: over 32 pixels it bends by less than a thousandth of a pixel.
constexpr int kLatticePx = 32;

/// Tiles of one level, each read once. A picture of kMaxGroundPx needs at most 10 x 10 of them.
class TileReader {
 public:
  TileReader(const TileSource& tiles, int level, const terrain::Cancelled& cancelled)
      : tiles_(tiles), level_(level), cancelled_(cancelled) {}

  /// Errors: as TileSource::tile. @return null where there is no imagery
  Result<const Tile*> at(int col, int row) {
    const TileId id{level_, col, row};
    const auto known = read_.find(id);
    if (known != read_.end()) return known->second.rgb.empty() ? nullptr : &known->second;
    Tile tile;
    if (tiles_.coverage(id) != terrain::TileCoverage::kNone) {
      Result<Tile> opened = tiles_.tile(id, cancelled_);
      if (!opened) return opened.error();
      tile = std::move(*opened);
    }
    const Tile& kept = read_.emplace(id, std::move(tile)).first->second;
    return kept.rgb.empty() ? nullptr : &kept;
  }

 private:
  const TileSource& tiles_;
  int level_;
  terrain::Cancelled cancelled_;
  std::map<TileId, Tile> read_;
};

/// Map positions of the picture's pixels.
class MapLattice {
 public:
  MapLattice(const TileSource& tiles, const GroundExtent& extent, int width_px, int height_px)
      : columns_(width_px / kLatticePx + 2) {
    const double step_east = (extent.east_high_m - extent.east_low_m) / width_px;
    const double step_north = (extent.north_high_m - extent.north_low_m) / height_px;
    for (int row = 0; row < height_px / kLatticePx + 2; ++row) {
      for (int column = 0; column < columns_; ++column) {
        nodes_.push_back(tiles.map_from_world(extent.east_low_m + step_east * kLatticePx * column,
                                              extent.north_high_m - step_north * kLatticePx * row));
      }
    }
  }

  /// @param x, y  in pixels from the picture's north-west corner
  [[nodiscard]] Eigen::Vector2d at(double x, double y) const {
    const int column = static_cast<int>(x / kLatticePx);
    const int row = static_cast<int>(y / kLatticePx);
    const double right = x / kLatticePx - column;
    const double down = y / kLatticePx - row;
    return (1.0 - down) * ((1.0 - right) * node(column, row) + right * node(column + 1, row)) +
           down * ((1.0 - right) * node(column, row + 1) + right * node(column + 1, row + 1));
  }

 private:
  [[nodiscard]] const Eigen::Vector2d& node(int column, int row) const {
    return nodes_[static_cast<std::size_t>(row) * columns_ + column];
  }

  int columns_;
  std::vector<Eigen::Vector2d> nodes_;
};

int level_for(const terrain::TileGrid& grid, double pixel_m) {
  const int level = static_cast<int>(std::floor(std::log2(pixel_m / grid.texel_m)));
  return std::clamp(level, 0, std::max(0, grid.levels - 1));
}

using Rgb = std::array<std::uint8_t, 3>;

/// Bilinear colour at a place of a tile, in texels from its north-west corner without the border.
Rgb colour_at(const Tile& tile, double x, double y) {
  const double left = x + terrain::kTileBorder - 0.5;
  const double top = y + terrain::kTileBorder - 0.5;
  const int column = std::clamp(static_cast<int>(std::floor(left)), 0, terrain::kTileSide - 2);
  const int row = std::clamp(static_cast<int>(std::floor(top)), 0, terrain::kTileSide - 2);
  const double right = std::clamp(left - column, 0.0, 1.0);
  const double down = std::clamp(top - row, 0.0, 1.0);
  Rgb rgb{};
  for (int channel = 0; channel < 3; ++channel) {
    const auto texel = [&](int dx, int dy) {
      return static_cast<double>(tile.rgb.at(column + dx, row + dy, channel));
    };
    const double value = (1.0 - down) * ((1.0 - right) * texel(0, 0) + right * texel(1, 0)) +
                         down * ((1.0 - right) * texel(0, 1) + right * texel(1, 1));
    rgb[static_cast<std::size_t>(channel)] = static_cast<std::uint8_t>(std::lround(value));
  }
  return rgb;
}

/// Colour at a place of the map plane. Errors: as TileSource::tile.
Result<Rgb> colour_of(TileReader& tiles,
                      const terrain::TileGrid& grid,
                      int level,
                      const Eigen::Vector2d& map_m) {
  constexpr Rgb kVoid{terrain::kVoidRgb[0], terrain::kVoidRgb[1], terrain::kVoidRgb[2]};
  const double across = (map_m.x() - grid.left_x_m) / grid.tile_m(level);
  const double down = (grid.top_y_m - map_m.y()) / grid.tile_m(level);
  const bool inside = across >= 0.0 && across <= 1e6 && down >= 0.0 && down <= 1e6;
  if (!inside) return kVoid;
  const int col = static_cast<int>(across);
  const int row = static_cast<int>(down);
  const Result<const Tile*> tile = tiles.at(col, row);
  if (!tile) return tile.error();
  if (*tile == nullptr) return kVoid;
  return colour_at(
      **tile, (across - col) * terrain::kTileTexels, (down - row) * terrain::kTileTexels);
}

}  // namespace

Result<Image> ground_picture(const TileSource& tiles,
                             const GroundExtent& extent,
                             int width_px,
                             int height_px,
                             const terrain::Cancelled& cancelled) {
  assert(width_px >= 1 && width_px <= kMaxGroundPx && height_px >= 1 && height_px <= kMaxGroundPx);
  const terrain::TileGrid& grid = tiles.grid();
  const double pixel_m = std::min((extent.east_high_m - extent.east_low_m) / width_px,
                                  (extent.north_high_m - extent.north_low_m) / height_px);
  const int level = level_for(grid, pixel_m);
  TileReader reader(tiles, level, cancelled);
  const terrain::HeightErrors errors;
  const MapLattice lattice(tiles, extent, width_px, height_px);
  Image picture(width_px, height_px, 3);
  for (int y = 0; y < height_px; ++y) {
    for (int x = 0; x < width_px; ++x) {
      const Result<Rgb> rgb = colour_of(reader, grid, level, lattice.at(x + 0.5, y + 0.5));
      if (!rgb) return rgb.error();
      std::copy(rgb->begin(), rgb->end(), &picture.at(x, y));
    }
  }
  if (Status read = errors.status(); !read) return read.error();
  return picture;
}

}  // namespace overfly::server::report
