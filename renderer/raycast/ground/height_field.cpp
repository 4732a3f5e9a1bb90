#include "renderer/raycast/ground/height_field.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/ground/ground_reach.hpp"

namespace overfly::renderer::raycast {

namespace {

constexpr double kNearestM = 0.5;

/// Lowest and highest up coordinate of a tile's ground, with a margin for relief between its posts.
Eigen::Vector2d height_bounds(const HeightTile& tile, double relief_m) {
  const double low_m = tile.up_m + tile.lowest_m;
  const double high_m = tile.up_m + tile.highest_m.whole();
  const double side_m = tile.id.side_m();
  const double margin_m = std::min(relief_m, std::max(0.5 * (high_m - low_m), 0.1 * side_m)) + 0.5;
  return {low_m - margin_m, high_m + margin_m};
}

}  // namespace

HeightField::HeightField(std::shared_ptr<const terrain::TileSource> tiles, std::size_t max_tiles)
    : tiles_(std::move(tiles)), map_(TexelMap::of(*tiles_)), max_tiles_(max_tiles) {}

const HeightTile& HeightField::tile(const HeightTileId& id) {
  auto known = kept_.find(id);
  if (known != kept_.end()) {
    order_.splice(order_.begin(), order_, known->second.place);
  } else {
    auto sampled = std::make_unique<HeightTile>(HeightTile::sample(id, map_));
    Order place{id};
    known = kept_.emplace(id, Kept{std::move(sampled), place.begin()}).first;
    order_.splice(order_.begin(), place);
  }
  known->second.tile->last_use = view_;
  return *known->second.tile;
}

bool HeightField::outside(const HeightTile& tile, const ViewSweep& view) const {
  const Eigen::Vector2d range_m = tiles_->height_range_m();
  const Eigen::Vector2d height = height_bounds(tile, range_m.y() - range_m.x());
  const double half_m = 0.5 * tile.id.side_m();
  const Eigen::Vector3d centre =
      Eigen::Vector3d(
          tile.east_m + half_m, tile.north_m + half_m, 0.5 * (height.x() + height.y())) -
      view.position;
  const Eigen::Vector3d half(half_m, half_m, 0.5 * (height.y() - height.x()));
  return std::any_of(view.side_normals.begin(), view.side_normals.end(), [&](const auto& normal) {
    return normal.dot(centre) + normal.cwiseAbs().dot(half) + view.slack_m < 0.0;
  });
}

bool HeightField::fine_enough(const HeightTile& tile, const ViewSweep& view) const {
  if (tile.id.level <= 0) return true;
  const double side_m = tile.id.side_m();
  const Eigen::Vector3d low(tile.east_m, tile.north_m, tile.up_m + tile.lowest_m);
  const Eigen::Vector3d high(
      tile.east_m + side_m, tile.north_m + side_m, tile.up_m + tile.highest_m.whole());
  const Eigen::Vector3d away =
      (low - view.position).cwiseMax(view.position - high).cwiseMax(Eigen::Vector3d::Zero());
  const double px_per_m = view.px_per_rad / std::max(away.norm() - view.slack_m, kNearestM);
  const double cell_px = tile.spacing_m * px_per_m;
  if (cell_px > kMaxCellPx) return false;
  if (cell_px < 2.0 * kMinCellPx) return true;
  return tile.hidden_m * px_per_m < kSurfaceErrorPx;
}

std::int32_t HeightField::visit(const HeightTileId& id,
                                std::int32_t parent,
                                const ViewSweep& view) {
  const HeightTile& here = tile(id);
  if (outside(here, view)) return -1;
  const auto index = static_cast<std::int32_t>(tree_.nodes.size());
  GroundNode node;
  node.tile = &here;
  node.east_m = here.east_m;
  node.north_m = here.north_m;
  node.side_m = id.side_m();
  node.parent = parent;
  node.leaf = fine_enough(here, view);
  tree_.nodes.push_back(node);
  double highest_m = here.up_m + here.highest_m.whole();
  if (node.leaf) {
    tree_.steepest = std::max<double>(tree_.steepest, here.steepest);
  } else {
    highest_m = -1e9;
    for (int i = 0; i < 4; ++i) {
      const HeightTileId child{id.level - 1, 2 * id.col + (i & 1), 2 * id.row + (i >> 1)};
      const std::int32_t at = visit(child, index, view);
      tree_.nodes[index].children[i] = at;
      if (at >= 0) highest_m = std::max(highest_m, tree_.nodes[at].highest_m);
    }
  }
  tree_.nodes[index].highest_m = highest_m;
  return index;
}

/// Distance to the farthest visible ground: the camera's horizon plus that of the highest ground,
/// or the distance at which the view's lowest corner is certainly below all ground.
double HeightField::reach_m(const ViewSweep& view) const {
  const Eigen::Vector2d range_m = tiles_->height_range_m();
  const Geodetic camera = tiles_->frame().geodetic_from_world(view.position);
  const double above_m = std::max(camera.alt_ellipsoid_m - range_m.x(), 2.0) + view.slack_m;
  const double relief_m = std::max(range_m.y() - range_m.x(), 0.0);
  const double to_horizon_m = horizon_m(above_m, relief_m);
  if (!view.bounded) return to_horizon_m;
  const double centre_m = view.position.head<2>().norm();
  double reach_m = 0.0;
  for (const Eigen::Vector3d& corner : view.corners) {
    const double level = corner.head<2>().norm();
    if (!(-corner.z() > 0.02 * level)) return to_horizon_m;
    const double run = level / -corner.z();
    double ground_m = above_m * run;
    for (int i = 0; i < 20; ++i) {
      const double farthest_m = centre_m + ground_m;
      const double drop_m = farthest_m * farthest_m / (2.0 * kEarthRadiusM) -
                            centre_m * centre_m / (2.0 * kEarthRadiusM);
      ground_m = (above_m + drop_m + 2.0) * run;
    }
    reach_m = std::max(reach_m, ground_m);
  }
  return std::min(1.05 * reach_m + 10.0 + 2.0 * view.slack_m, to_horizon_m);
}

HeightTileId HeightField::first_root(const ViewSweep& view) const {
  const double reach = reach_m(view);
  int level = kLog2TileCells;
  while (level < 24 && HeightTileId{level, 0, 0}.side_m() < reach) ++level;
  const double side_m = HeightTileId{level, 0, 0}.side_m();
  return {level,
          static_cast<std::int32_t>(std::floor(view.position.x() / side_m)) - 1,
          static_cast<std::int32_t>(std::floor(view.position.y() / side_m)) - 1};
}

const GroundTree& HeightField::select(const ViewSweep& view) {
  ++view_;
  tree_ = {};
  tree_.roots.fill(-1);
  const auto [level, col, row] = first_root(view);
  tree_.side_m = HeightTileId{level, 0, 0}.side_m();
  tree_.east_m = col * tree_.side_m;
  tree_.north_m = row * tree_.side_m;
  for (int i = 0; i < 9; ++i) {
    const std::int32_t root = visit({level, col + i % 3, row + i / 3}, -1, view);
    tree_.roots[i] = root;
    if (root >= 0) tree_.highest_m = std::max(tree_.highest_m, tree_.nodes[root].highest_m);
  }
  forget_old();
  return tree_;
}

void HeightField::prepare(const ViewSweep& later) {
  const auto [level, col, row] = first_root(later);
  for (int i = 0; i < 9; ++i) {
    if (prepare_below({level, col + i % 3, row + i / 3}, later)) return;
  }
}

bool HeightField::prepare_below(const HeightTileId& id, const ViewSweep& later) {
  const auto known = kept_.find(id);
  if (known == kept_.end()) {
    (void)tile(id);
    return true;
  }
  const HeightTile& here = *known->second.tile;
  if (outside(here, later) || fine_enough(here, later)) return false;
  for (int i = 0; i < 4; ++i) {
    if (prepare_below({id.level - 1, 2 * id.col + (i & 1), 2 * id.row + (i >> 1)}, later)) {
      return true;
    }
  }
  return false;
}

void HeightField::forget_old() {
  while (kept_.size() > max_tiles_) {
    const auto oldest = kept_.find(order_.back());
    // The tiles of the latest view stay, because the tree points to them.
    if (oldest->second.tile->last_use == view_) return;
    kept_.erase(oldest);
    order_.pop_back();
  }
}

}  // namespace overfly::renderer::raycast
