#include "renderer/raycast/ground/tile_march.hpp"

#include <algorithm>
#include <cmath>

namespace overfly::renderer::raycast {

namespace {

/// Parameter at which a coordinate that moves from `from` enters [low, low + 1].
double enter(double from, double per_rate, double low) {
  if (std::isinf(per_rate)) return -kNever;
  return ((per_rate > 0.0 ? low : low + 1.0) - from) * per_rate;
}

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
  const CellSurface cell(tile, column, row);
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
    const CellSurface cell(tile, at.column, at.row);
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

}  // namespace

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

}  // namespace overfly::renderer::raycast
