#include "renderer/raycast/ground/ground_caster.hpp"

#include <algorithm>
#include <cmath>

#include "renderer/raycast/ground/tile_march.hpp"

namespace overfly::renderer::raycast {

const GroundNode* GroundCaster::leaf_at(double east_m, double north_m) const {
  const double col = (east_m - tree_.east_m) / tree_.side_m;
  const double row = (north_m - tree_.north_m) / tree_.side_m;
  if (!(col >= 0.0 && col < 3.0 && row >= 0.0 && row < 3.0)) return nullptr;
  std::int32_t at = tree_.roots[static_cast<int>(row) * 3 + static_cast<int>(col)];
  while (at >= 0) {
    const GroundNode& node = tree_.nodes[at];
    if (node.leaf) return &node;
    const double half_m = 0.5 * node.side_m;
    at = node.children[(north_m >= node.north_m + half_m ? 2 : 0) +
                       (east_m >= node.east_m + half_m ? 1 : 0)];
  }
  return nullptr;
}

GroundHit GroundCaster::cast(const Eigen::Vector3d& origin,
                             const Eigen::Vector3d& direction,
                             double guess,
                             const GroundNode* near) const {
  if (guess > 0.0 && meets_ground_once(direction)) {
    const GroundHit hit = descend(origin, direction, guess, near);
    if (!hit.sky()) return hit;
  }
  return march(origin, direction, guess, near);
}

GroundHit GroundCaster::descend(const Eigen::Vector3d& origin,
                                const Eigen::Vector3d& direction,
                                double guess,
                                const GroundNode* near) const {
  double t = guess;
  const GroundNode* node = near;
  for (int i = 0; i < 8; ++i) {
    const double east_m = origin.x() + t * direction.x();
    const double north_m = origin.y() + t * direction.y();
    if (node == nullptr || !node->holds(east_m, north_m)) node = leaf_at(east_m, north_m);
    if (node == nullptr) return {};
    const HeightTile& tile = *node->tile;
    const double scale = tile.per_m;
    const double e = (east_m - node->east_m) * scale;
    const double n = (north_m - node->north_m) * scale;
    const int column = std::min(static_cast<int>(e), kTileCells - 1);
    const int row = std::min(static_cast<int>(n), kTileCells - 1);
    const CellSurface cell(tile, column, row);
    const double x = e - column;
    const double y = n - row;
    const double slope_east = cell.a + cell.c * y;
    const double slope_north = cell.b + cell.c * x;
    const double clearance =
        origin.z() + t * direction.z() - tile.up_m - (cell.sw + slope_east * x + cell.b * y);
    const double rate =
        direction.z() - scale * (slope_east * direction.x() + slope_north * direction.y());
    if (!(rate < 0.0)) return {};
    const double step = clearance / rate;
    t -= step;
    if (!(t > 0.0)) return {};
    // The remaining error is far smaller than the step: at most a thousandth of a pixel, at a kink.
    if (std::abs(step) > 1e-5 * t) continue;
    GroundHit hit;
    hit.depth = std::max(t, kNearest);
    hit.node = node;
    hit.column = column;
    hit.row = row;
    hit.across = x - step * direction.x() * scale;
    hit.up = y - step * direction.y() * scale;
    return hit;
  }
  return {};
}

GroundHit GroundCaster::march(const Eigen::Vector3d& origin,
                              const Eigen::Vector3d& direction,
                              double guess,
                              const GroundNode* near) const {
  // A square near the ray: the search for the next one begins there, not at the root. A falling ray
  // that does not pass above a square does not do so further inside either.
  auto from = near != nullptr ? static_cast<std::int32_t>(near - tree_.nodes.data()) : -1;
  double t = 0.0;
  if (origin.z() > tree_.highest_m) {
    if (!(direction.z() < 0.0)) return {};
    t = (tree_.highest_m - origin.z()) / direction.z();
  }
  const double per_east = 1.0 / direction.x();
  const double per_north = 1.0 / direction.y();
  const double ahead_east_m = std::copysign(kAhead, direction.x());
  const double ahead_north_m = std::copysign(kAhead, direction.y());
  while (true) {
    const double east_m = origin.x() + t * direction.x() + ahead_east_m;
    const double north_m = origin.y() + t * direction.y() + ahead_north_m;
    if (direction.z() > 0.0 && origin.z() + t * direction.z() > tree_.highest_m) return {};
    while (from >= 0 && !tree_.nodes[from].holds(east_m, north_m)) from = tree_.nodes[from].parent;
    std::int32_t at = from;
    double low_east = 0.0, low_north = 0.0, side = tree_.side_m;
    if (at >= 0) {
      const GroundNode& around = tree_.nodes[at];
      low_east = around.east_m;
      low_north = around.north_m;
      side = around.side_m;
    } else {
      const double col = std::floor((east_m - tree_.east_m) / tree_.side_m);
      const double row = std::floor((north_m - tree_.north_m) / tree_.side_m);
      if (!(col >= 0.0 && col < 3.0 && row >= 0.0 && row < 3.0)) return {};
      at = tree_.roots[static_cast<int>(row) * 3 + static_cast<int>(col)];
      low_east = tree_.east_m + col * tree_.side_m;
      low_north = tree_.north_m + row * tree_.side_m;
    }
    while (true) {
      double end = std::min(leave(origin.x(), per_east, low_east, side),
                            leave(origin.y(), per_north, low_north, side));
      end = std::max(std::min(end, kFarthest), t);
      const GroundNode* node = at >= 0 ? &tree_.nodes[at] : nullptr;
      if (node != nullptr) from = at;
      const double lowest = origin.z() + direction.z() * (direction.z() < 0.0 ? end : t);
      if (node == nullptr || lowest > node->highest_m) {
        t = end;
        break;
      }
      if (node->leaf) {
        const GroundHit hit = march_tile(*node, TileRay(*node, origin, direction), t, end, guess);
        if (!hit.sky()) return hit;
        t = end;
        break;
      }
      side *= 0.5;
      const bool east = east_m >= low_east + side;
      const bool north = north_m >= low_north + side;
      at = node->children[(north ? 2 : 0) + (east ? 1 : 0)];
      if (east) low_east += side;
      if (north) low_north += side;
    }
    if (!(t < kFarthest)) return {};
  }
}

double relief_around(const GroundTree& tree, const GroundHit& hit, double size_m) {
  const GroundNode* node = hit.node;
  int column = hit.column, row = hit.row;
  while (true) {
    const double cells = size_m * node->tile->per_m;
    if (cells <= 2.0) {
      // Close to a kink the deviation decreases with the size.
      return node->tile->deviation_m.at(1, {column, row}) * 0.5 * cells;
    }
    if (cells <= kTileCells || node->parent < 0) {
      int k = 1;
      while (k < kLog2TileCells && (1 << k) < cells) ++k;
      return node->tile->deviation_m.at(k, {column, row});
    }
    const GroundNode& parent = tree.nodes[node->parent];
    const bool east = node->east_m > parent.east_m;
    const bool north = node->north_m > parent.north_m;
    column = (column + (east ? kTileCells : 0)) / 2;
    row = (row + (north ? kTileCells : 0)) / 2;
    node = &parent;
  }
}

}  // namespace overfly::renderer::raycast
