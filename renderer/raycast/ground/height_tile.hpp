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

struct HeightTile {
  HeightTileId id;
  double east_m = 0.0, north_m = 0.0;  ///< south-west corner
  double spacing_m = 0.0;
  double per_m = 0.0;                  ///< cells per metre
  double up_m = 0.0;                   ///< reference of `height_m`
  Eigen::Vector2d texel = {0.0, 0.0};  ///< reference of `texels`
  std::array<float, kTilePosts * kTilePosts> height_m{};
  std::vector<Eigen::Vector2f> texels;  ///< by post, as height_m
  /// Highest post of each square of 2^k cells a side, above up_m.
  std::array<std::vector<float>, kLog2TileCells + 1> highest_m;
  /// Largest vertical distance between the posts in a square of 2^k cells and the bilinear surface
  /// through its corners; for k = 0 a bound for the ground between the posts.
  std::array<std::vector<float>, kLog2TileCells + 1> deviation_m;
  float hidden_m = 0.0F;  ///< the largest of deviation_m[0]
  float lowest_m = 0.0F;
  float steepest = 0.0F;  ///< bound of the slope's length between the posts
  std::uint64_t last_use = 0;

  static HeightTile sample(const HeightTileId& id, const TexelMap& map);

  [[nodiscard]] float height(int column, int row) const {
    return height_m[static_cast<std::size_t>(row) * kTilePosts + column];
  }
  [[nodiscard]] const Eigen::Vector2f& texel_at(int column, int row) const {
    return texels[static_cast<std::size_t>(row) * kTilePosts + column];
  }
  /// @param column, row  of a cell
  [[nodiscard]] float highest(int k, int column, int row) const {
    return highest_m[k][static_cast<std::size_t>(row >> k) * (kTileCells >> k) + (column >> k)];
  }
  [[nodiscard]] float deviation(int k, int column, int row) const {
    return deviation_m[k][static_cast<std::size_t>(row >> k) * (kTileCells >> k) + (column >> k)];
  }
};

}  // namespace overfly::renderer::raycast
