// A square piece of the ground's surface over the world frame's east-north plane.
//
// Tiles of level L span kTileCells cells of kFinestSpacingM * 2^L; tile (L, col, row) begins at
// (col, row) times its side, col to the east and row to the north. Between its posts the ground is
// bilinear, in height and in its place on the map.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <compare>
#include <cstdint>
#include <vector>

#include "terrain/tile_source.hpp"

namespace overfly::renderer::raycast {

inline constexpr int kLog2TileCells = 5;
inline constexpr int kTileCells = 1 << kLog2TileCells;  ///< along a side
inline constexpr int kTilePosts = kTileCells + 1;
inline constexpr double kFinestSpacingM = 0.125;

struct HeightTileId {
  int level = 0;
  std::int32_t col = 0;
  std::int32_t row = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): the check mistakes the generated comparison with 0.
  auto operator<=>(const HeightTileId&) const = default;

  [[nodiscard]] double spacing_m() const { return std::ldexp(kFinestSpacingM, level); }
  [[nodiscard]] double side_m() const { return kTileCells * spacing_m(); }
};

/// The map in texels of the imagery's level 0: x to the east from the grid's left edge, y to the
/// south from its top edge.
struct TexelMap {
  const terrain::TileSource* tiles = nullptr;
  /// d(map) / d(east, north) near the world's origin.
  Eigen::Matrix2d map_per_world = Eigen::Matrix2d::Identity();
  Eigen::Vector2d origin_map_m{0.0, 0.0};  ///< of the world's origin

  static TexelMap of(const terrain::TileSource& tiles);
  [[nodiscard]] Eigen::Vector2d texel_from_map(const Eigen::Vector2d& map_m) const {
    const terrain::TileGrid& grid = tiles->grid();
    return {(map_m.x() - grid.left_x_m) / grid.texel_m, (grid.top_y_m - map_m.y()) / grid.texel_m};
  }
};

/// The place of a cell in Morton's order, in which the four parts of a square are neighbours.
class CellPlace {
 public:
  CellPlace(int column, int row)
      : place_(kSpread[column] | static_cast<unsigned>(kSpread[row]) << 1U) {}
  /// Of the square of 2^k cells a side that contains the cell, among those of this size.
  [[nodiscard]] unsigned of_square(int k) const { return place_ >> (2 * k); }

 private:
  /// The bits of a number, with a zero before each.
  static constexpr auto kSpread = [] {
    std::array<std::uint16_t, kTileCells> spread{};
    for (unsigned i = 0; i < kTileCells; ++i) {
      for (unsigned bit = 0; bit < kLog2TileCells; ++bit) {
        spread[i] |= static_cast<std::uint16_t>((i >> bit & 1U) << (2 * bit));
      }
    }
    return spread;
  }();
  unsigned place_;
};

/// One value for each square of 2^k cells a side of a tile, from kFinest to the whole tile. The
/// coarsest come first: what a ray reads on its way down to a cell lies together in memory.
template <int kFinest>
class SquareTable {
 public:
  /// @param cell  of the square
  [[nodiscard]] float at(int k, const CellPlace& cell) const { return values_[index(k, cell)]; }
  void set(int k, const CellPlace& cell, float value) { values_[index(k, cell)] = value; }
  /// The value of the whole tile.
  [[nodiscard]] float whole() const { return values_[0]; }

 private:
  /// Number of squares larger than those of 2^k cells a side.
  static constexpr auto kLarger = [] {
    std::array<std::uint16_t, kLog2TileCells + 2> larger{};
    for (int k = kLog2TileCells; k-- > 0;) {
      larger[k] = static_cast<std::uint16_t>(4 * larger[k + 1] + 1);
    }
    return larger;
  }();
  static std::size_t index(int k, const CellPlace& cell) {
    return std::size_t{kLarger[k]} + cell.of_square(k);
  }

  static constexpr std::size_t kCount =
      kFinest == 0 ? 4 * std::size_t{kLarger[0]} + 1 : std::size_t{kLarger[kFinest - 1]};
  std::array<float, kCount> values_{};
};

/// A corner of cells. Height and place side by side: a hit needs both.
struct GroundPost {
  float height_m = 0.0F;              ///< above the tile's up_m
  Eigen::Vector2f texel{0.0F, 0.0F};  ///< relative to the tile's texel
};

struct HeightTile {
  HeightTileId id;
  double east_m = 0.0, north_m = 0.0;  ///< south-west corner
  double spacing_m = 0.0;
  double per_m = 0.0;                  ///< cells per metre
  double up_m = 0.0;                   ///< reference of the posts' heights
  Eigen::Vector2d texel = {0.0, 0.0};  ///< reference of the posts' texels
  std::array<GroundPost, kTilePosts * kTilePosts> posts{};
  /// Highest post of each square, above up_m.
  SquareTable<0> highest_m;
  /// Largest vertical distance between the posts in a square and the bilinear surface through its
  /// corners.
  SquareTable<1> deviation_m;
  float hidden_m = 0.0F;  ///< bound of the same for the ground between the posts
  float lowest_m = 0.0F;
  /// Limits of the slopes to the east and to the north, d(height) / d(east) and d(height) /
  /// d(north).
  Eigen::Vector2f lowest_slope{0.0F, 0.0F};
  Eigen::Vector2f highest_slope{0.0F, 0.0F};
  float steepest = 0.0F;  ///< bound of the slope's length between the posts
  std::uint64_t last_use = 0;

  static HeightTile sample(const HeightTileId& id, const TexelMap& map);

  [[nodiscard]] const GroundPost& post(int column, int row) const {
    return posts[static_cast<std::size_t>(row) * kTilePosts + column];
  }
  [[nodiscard]] float height(int column, int row) const { return post(column, row).height_m; }
  [[nodiscard]] const Eigen::Vector2f& texel_at(int column, int row) const {
    return post(column, row).texel;
  }
};

}  // namespace overfly::renderer::raycast
