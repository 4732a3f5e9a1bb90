#include "renderer/raycast/ground/height_tile.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

namespace overfly::renderer::raycast {

namespace {

/// Height if no map point is found: so low that nothing is visible there.
constexpr double kAbyssM = -1e6;

/// A point of the ground and its place on the map.
struct Post {
  Eigen::Vector2d map_m{0.0, 0.0};
  double up_m = kAbyssM;
};

/// Finds the ground above points of the east-north plane.
class Sampler {
 public:
  Sampler(const HeightTileId& id, const TexelMap& map) : map_(map), spacing_m_(id.spacing_m()) {}

  /// Moves a guess on the map until the ground there lies above (east, north).
  [[nodiscard]] Post find(const Eigen::Vector2d& wanted, const Eigen::Vector2d& guess_m) const {
    Post post;
    post.map_m = guess_m;
    // The remaining offset times the slope is an error of height, far below the tile's own error.
    const double close_m = 1e-3 * spacing_m_;
    for (int i = 0; i < 20; ++i) {
      // Half the spacing averages away relief that the cells cannot represent, and keeps the rest.
      const Eigen::Vector3d p =
          map_.tiles->coarse_world_from_map(post.map_m.x(), post.map_m.y(), 0.5 * spacing_m_);
      if (!p.allFinite()) break;
      const Eigen::Vector2d miss = wanted - p.head<2>();
      post.map_m += map_.map_per_world * miss;
      post.up_m = p.z();
      if (miss.cwiseAbs().maxCoeff() < close_m) return post;
    }
    post.up_m = kAbyssM;
    return post;
  }

 private:
  const TexelMap& map_;
  double spacing_m_;
};

void sample_posts(HeightTile& tile, const TexelMap& map) {
  const Sampler sampler(tile.id, map);
  const auto world = [&](int column, int row) {
    return Eigen::Vector2d(tile.east_m + column * tile.spacing_m,
                           tile.north_m + row * tile.spacing_m);
  };
  std::array<Eigen::Vector2d, 4> corners;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2d at = world((i & 1) * kTileCells, (i >> 1) * kTileCells);
    corners[i] = sampler.find(at, map.origin_map_m + map.map_per_world * at).map_m;
  }
  std::array<double, kTilePosts * kTilePosts> up_m{};
  tile.texel = map.texel_from_map(0.25 * (corners[0] + corners[1] + corners[2] + corners[3]));
  for (int row = 0; row < kTilePosts; ++row) {
    const double b = static_cast<double>(row) / kTileCells;
    for (int column = 0; column < kTilePosts; ++column) {
      const double a = static_cast<double>(column) / kTileCells;
      const Eigen::Vector2d guess_m = (1.0 - b) * ((1.0 - a) * corners[0] + a * corners[1]) +
                                      b * ((1.0 - a) * corners[2] + a * corners[3]);
      const Post post = sampler.find(world(column, row), guess_m);
      const std::size_t i = static_cast<std::size_t>(row) * kTilePosts + column;
      up_m[i] = post.up_m;
      tile.posts[i].texel = (map.texel_from_map(post.map_m) - tile.texel).cast<float>();
    }
  }
  tile.up_m = up_m[up_m.size() / 2];
  for (std::size_t i = 0; i < up_m.size(); ++i) {
    tile.posts[i].height_m = static_cast<float>(up_m[i] - tile.up_m);
  }
}

void measure_heights(HeightTile& tile) {
  tile.lowest_m = tile.posts[0].height_m;
  for (const GroundPost& post : tile.posts) tile.lowest_m = std::min(tile.lowest_m, post.height_m);
  // Along the sides of the cells; between them a bilinear surface is no steeper.
  Eigen::Array2f least = Eigen::Array2f::Constant(std::numeric_limits<float>::max());
  Eigen::Array2f most = -least;
  for (int row = 0; row < kTileCells; ++row) {
    for (int column = 0; column < kTileCells; ++column) {
      const float sw = tile.height(column, row), se = tile.height(column + 1, row);
      const float nw = tile.height(column, row + 1), ne = tile.height(column + 1, row + 1);
      tile.highest_m.set(0, {column, row}, std::max({sw, se, nw, ne}));
      for (const Eigen::Array2f& steps : {Eigen::Array2f(se - sw, nw - sw), {ne - nw, ne - se}}) {
        least = least.min(steps);
        most = most.max(steps);
      }
    }
  }
  const auto spacing_m = static_cast<float>(tile.spacing_m);
  tile.lowest_slope = least / spacing_m;
  tile.highest_slope = most / spacing_m;
  const Eigen::Array2f steepest = most.max(-least);
  tile.steepest = std::hypot(steepest.x(), steepest.y()) / spacing_m;
  for (int k = 1; k <= kLog2TileCells; ++k) {
    const int half = 1 << (k - 1);
    for (int row = 0; row < kTileCells; row += 2 * half) {
      for (int column = 0; column < kTileCells; column += 2 * half) {
        const auto part = [&](int east, int north) {
          return tile.highest_m.at(k - 1, {column + east, row + north});
        };
        tile.highest_m.set(k,
                           {column, row},
                           std::max({part(0, 0), part(half, 0), part(0, half), part(half, half)}));
      }
    }
  }
}

float square_deviation(const HeightTile& tile, int column, int row, int cells) {
  const float sw = tile.height(column, row), se = tile.height(column + cells, row);
  const float nw = tile.height(column, row + cells);
  const float ne = tile.height(column + cells, row + cells);
  const float scale = 1.0F / static_cast<float>(cells);
  float worst = 0.0F;
  for (int j = 0; j <= cells; ++j) {
    const float b = static_cast<float>(j) * scale;
    const float west = sw + b * (nw - sw);
    const float slope = (se + b * (ne - se) - west) * scale;
    const GroundPost* posts = &tile.post(column, row + j);
    for (int i = 0; i <= cells; ++i) {
      worst = std::max(worst, std::abs(posts[i].height_m - (west + slope * static_cast<float>(i))));
    }
  }
  return worst;
}

void measure_deviations(HeightTile& tile) {
  for (int k = 1; k <= kLog2TileCells; ++k) {
    const int cells = 1 << k;
    for (int row = 0; row < kTileCells; row += cells) {
      for (int column = 0; column < kTileCells; column += cells) {
        tile.deviation_m.set(k, {column, row}, square_deviation(tile, column, row, cells));
      }
    }
  }
  // Between the posts: cells half as long as those of k = 1 have half the deviation of a kinked
  // surface, and a quarter of that of a smooth one.
  for (int row = 0; row < kTileCells; row += 2) {
    for (int column = 0; column < kTileCells; column += 2) {
      tile.hidden_m = std::max(tile.hidden_m, 0.5F * tile.deviation_m.at(1, {column, row}));
    }
  }
}

}  // namespace

TexelMap TexelMap::of(const terrain::TileSource& tiles) {
  TexelMap map;
  map.tiles = &tiles;
  map.origin_map_m = tiles.map_from_world(0.0, 0.0);
  constexpr double kStepM = 100.0;
  map.map_per_world.col(0) =
      (tiles.map_from_world(kStepM, 0.0) - tiles.map_from_world(-kStepM, 0.0)) / (2.0 * kStepM);
  map.map_per_world.col(1) =
      (tiles.map_from_world(0.0, kStepM) - tiles.map_from_world(0.0, -kStepM)) / (2.0 * kStepM);
  return map;
}

HeightTile HeightTile::sample(const HeightTileId& id, const TexelMap& map) {
  HeightTile tile;
  tile.id = id;
  tile.spacing_m = id.spacing_m();
  tile.per_m = 1.0 / tile.spacing_m;
  tile.east_m = id.col * id.side_m();
  tile.north_m = id.row * id.side_m();
  sample_posts(tile, map);
  measure_heights(tile);
  measure_deviations(tile);
  return tile;
}

}  // namespace overfly::renderer::raycast
