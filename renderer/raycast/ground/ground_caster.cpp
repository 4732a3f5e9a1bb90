#include "renderer/raycast/ground/ground_caster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace overfly::renderer::raycast {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kFarthest = 1e7;  // of a ray's parameter
// A camera below the ground sees the ground directly in front of it
constexpr double kNearest = 0.05;
/// A square is chosen by the point this far ahead along each axis (metres, or cells of a tile), so
/// that a ray on a square's side belongs to the square that it enters, however slowly.
constexpr double kAhead = 1e-7;

/// A ray in the cells of one tile: place and height as functions of the ray's parameter.
struct TileRay {
  double column, row, height;        // at parameter 0, cells and metres
  double d_column, d_row, d_height;  // per unit of the parameter
  double per_column, per_row;        // of the parameter

  TileRay(const GroundNode& node, const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
    const double scale = node.tile->per_m;
    column = (o.x() - node.east_m) * scale;
    row = (o.y() - node.north_m) * scale;
    height = o.z() - node.tile->up_m;
    d_column = d.x() * scale;
    d_row = d.y() * scale;
    d_height = d.z();
    per_column = 1.0 / d_column;
    per_row = 1.0 / d_row;
  }
};

/// Parameter at which a coordinate that moves from `from` leaves [low, low + side].
/// @param per_rate  parameter per unit of the coordinate, infinite if it does not change
double leave(double from, double per_rate, double low, double side) {
  if (std::isinf(per_rate)) return kNever;
  return ((per_rate > 0.0 ? low + side : low) - from) * per_rate;
}

/// Parameter at which a coordinate that moves from `from` enters [low, low + 1].
double enter(double from, double per_rate, double low) {
  if (std::isinf(per_rate)) return -kNever;
  return ((per_rate > 0.0 ? low : low + 1.0) - from) * per_rate;
}

/// A cell's bilinear surface: h = sw + a e + b n + c e n over (e, n) in [0, 1]^2.
struct Bilinear {
  double sw, a, b, c;

  Bilinear(const HeightTile& tile, int column, int row) {
    sw = tile.height(column, row);
    a = tile.height(column + 1, row) - sw;
    b = tile.height(column, row + 1) - sw;
    c = tile.height(column + 1, row + 1) - sw - a - b;
  }
};

GroundHit hit_at(const GroundNode& node, const TileRay& ray, int column, int row, double depth) {
  GroundHit hit;
  hit.depth = std::max(depth, kNearest);
  hit.node = &node;
  hit.column = column;
  hit.row = row;
  hit.across = std::clamp(ray.column + depth * ray.d_column - column, 0.0, 1.0);
  hit.up = std::clamp(ray.row + depth * ray.d_row - row, 0.0, 1.0);
  return hit;
}

/// The first parameter in [from, to] at which the ray is not above a cell's surface.
double enter_cell(
    const HeightTile& tile, const TileRay& ray, int column, int row, double from, double to) {
  const Bilinear cell(tile, column, row);
  const double e = ray.column - column;
  const double n = ray.row - row;
  // Clearance A t^2 + B t + C.
  const double A = -cell.c * ray.d_column * ray.d_row;
  const double B = ray.d_height - cell.a * ray.d_column - cell.b * ray.d_row -
                   cell.c * (e * ray.d_row + n * ray.d_column);
  const double C = ray.height - cell.sw - cell.a * e - cell.b * n - cell.c * e * n;
  const auto clearance = [&](double t) { return (A * t + B) * t + C; };
  if (clearance(from) <= 0.0) return from;
  // Roots without cancellation.
  const double discriminant = B * B - 4.0 * A * C;
  if (discriminant < 0.0) return kNever;
  const double q = -0.5 * (B + std::copysign(std::sqrt(discriminant), B));
  double first = q != 0.0 ? C / q : kNever;
  double second = A != 0.0 ? q / A : kNever;
  if (second < first) std::swap(first, second);
  if (first >= from && first <= to) return first;
  if (second >= from && second <= to) return second;
  // Rounding may have moved the root across the cell's side.
  return clearance(to) <= 0.0 ? to : kNever;
}

/// The cell of a tile at a ray's parameter. Outside the tile, the nearest.
struct CellAt {
  int column, row;
  double e, n;  ///< place in the cell, east and north

  CellAt(const TileRay& ray, double t) {
    e = ray.column + t * ray.d_column;
    n = ray.row + t * ray.d_row;
    column = std::clamp(static_cast<int>(e), 0, kTileCells - 1);
    row = std::clamp(static_cast<int>(n), 0, kTileCells - 1);
    e -= column;
    n -= row;
  }
  bool operator==(const CellAt& other) const { return column == other.column && row == other.row; }
};

/// The most that the ground falls along one axis, per unit of a ray's parameter.
/// @param low, high  limits of the slope
double steepest_fall(double low, double high, double rate) {
  return -std::min(low * rate, high * rate);
}

enum class Descent { kPasses, kHits, kUnsure };

/// Finds where a ray meets a tile's ground if it falls more steeply than the ground does: then it
/// meets the ground once at most, and Newton's method leads to the cell. The hit has the bits that
/// a march finds; kUnsure where that is not certain.
/// @param guess  a parameter near the answer
Descent descend_tile(const GroundNode& node,
                     const TileRay& ray,
                     double from,
                     double to,
                     double guess,
                     GroundHit& hit) {
  const HeightTile& tile = *node.tile;
  // Distances that rounding does not reach.
  constexpr double kClearM = 1e-6;
  constexpr double kInside = 1e-7;
  // The ground falls no more steeply than this along the ray.
  const double fall = steepest_fall(tile.lowest_slope.x(), tile.highest_slope.x(), ray.d_column) +
                      steepest_fall(tile.lowest_slope.y(), tile.highest_slope.y(), ray.d_row);
  if (!(-0.999 * ray.d_height > tile.spacing_m * fall)) return Descent::kUnsure;
  double t = std::clamp(guess, from, to);
  for (int i = 0; i < 6; ++i) {
    const CellAt at(ray, t);
    const Bilinear cell(tile, at.column, at.row);
    const double clearance =
        ray.height + t * ray.d_height - (cell.sw + cell.a * at.e + (cell.b + cell.c * at.e) * at.n);
    if (t == to && clearance > kClearM) return Descent::kPasses;
    const double rate = ray.d_height - (cell.a + cell.c * at.n) * ray.d_column -
                        (cell.b + cell.c * at.e) * ray.d_row;
    t = std::clamp(t - clearance / rate, from, to);
    if (t == to || CellAt(ray, t) != at) continue;
    const double in = std::max(
        {from, enter(ray.column, ray.per_column, at.column), enter(ray.row, ray.per_row, at.row)});
    const double out = std::min({to,
                                 leave(ray.column, ray.per_column, at.column, 1.0),
                                 leave(ray.row, ray.per_row, at.row, 1.0)});
    const double depth = enter_cell(tile, ray, at.column, at.row, in, out);
    const double margin = kInside * (1.0 + t);
    if (!(depth > in + margin && depth < out - margin)) return Descent::kUnsure;
    hit = hit_at(node, ray, at.column, at.row, depth);
    return Descent::kHits;
  }
  return Descent::kUnsure;
}

/// Marches through one tile from parameter `from` to `to`; depth 0 if nothing is hit.
GroundHit march_tile(
    const GroundNode& node, const TileRay& ray, double from, double to, double guess) {
  GroundHit hit;
  switch (descend_tile(node, ray, from, to, guess, hit)) {
    case Descent::kHits:
      return hit;
    case Descent::kPasses:
      return {};
    case Descent::kUnsure:
      break;
  }
  const HeightTile& tile = *node.tile;
  // The ray does not pass above the whole tile.
  int k = kLog2TileCells - 1;
  int last_column = 0, last_row = 0;
  bool passed = false;
  double t = from;
  const double ahead_columns = std::copysign(kAhead, ray.d_column);
  const double ahead_rows = std::copysign(kAhead, ray.d_row);
  while (t < to) {
    const double at_column = ray.column + t * ray.d_column + ahead_columns;
    const double at_row = ray.row + t * ray.d_row + ahead_rows;
    const int column = std::clamp(static_cast<int>(at_column), 0, kTileCells - 1);
    const int row = std::clamp(static_cast<int>(at_row), 0, kTileCells - 1);
    // A larger square is tried only where the ray enters it: further inside a falling ray is no
    // higher above it.
    if (passed && ((column ^ last_column) | (row ^ last_row)) >> (k + 1) != 0) ++k;
    last_column = column;
    last_row = row;
    const CellPlace place(column, row);
    const double least_end = t + 1e-9 * (1.0 + t);
    // The largest square above which the ray passes, or the cell.
    for (passed = false; !passed; --k) {
      const int side = 1 << k;
      const double out =
          std::min(std::min(leave(ray.column, ray.per_column, column & ~(side - 1), side),
                            leave(ray.row, ray.per_row, row & ~(side - 1), side)),
                   to);
      const double end = std::max(out, least_end);
      const double lowest = ray.height + ray.d_height * (ray.d_height < 0.0 ? end : t);
      passed = lowest > tile.highest_m.at(k, place);
      if (!passed && k == 0) {
        const double depth = enter_cell(tile, ray, column, row, t, end);
        if (depth < kNever) return hit_at(node, ray, column, row, depth);
        passed = true;
      }
      if (passed) {
        t = end;
        break;
      }
    }
  }
  return {};
}

}  // namespace

Eigen::Vector2d GroundHit::texel() const {
  const HeightTile& tile = *node->tile;
  const Eigen::Vector2d sw = tile.texel_at(column, row).cast<double>();
  const Eigen::Vector2d se = tile.texel_at(column + 1, row).cast<double>();
  const Eigen::Vector2d nw = tile.texel_at(column, row + 1).cast<double>();
  const Eigen::Vector2d ne = tile.texel_at(column + 1, row + 1).cast<double>();
  const Eigen::Vector2d south = sw + across * (se - sw);
  const Eigen::Vector2d north = nw + across * (ne - nw);
  return tile.texel + (south + up * (north - south));
}

Eigen::Vector2d GroundHit::slope() const {
  const Bilinear cell(*node->tile, column, row);
  return Eigen::Vector2d(cell.a + cell.c * up, cell.b + cell.c * across) / node->tile->spacing_m;
}

Eigen::Matrix2d GroundHit::texels_per_m() const {
  const HeightTile& tile = *node->tile;
  const Eigen::Vector2f& sw = tile.texel_at(column, row);
  Eigen::Matrix2d J;
  J.col(0) = (tile.texel_at(column + 1, row) - sw).cast<double>();
  J.col(1) = (tile.texel_at(column, row + 1) - sw).cast<double>();
  return J / tile.spacing_m;
}

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
    const Bilinear cell(tile, column, row);
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
