// Rays through one height tile.
#pragma once

#include <cmath>
#include <limits>

#include "renderer/raycast/ground/ground_hit.hpp"

namespace overfly::renderer::raycast {

inline constexpr double kNever = std::numeric_limits<double>::infinity();
inline constexpr double kFarthest = 1e7;  // of a ray's parameter
// A camera below the ground sees the ground directly in front of it
inline constexpr double kNearest = 0.05;
/// A square is chosen by the point this far ahead along each axis (metres, or cells of a tile), so
/// that a ray on a square's side belongs to the square that it enters, however slowly.
inline constexpr double kAhead = 1e-7;

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
inline double leave(double from, double per_rate, double low, double side) {
  if (std::isinf(per_rate)) return kNever;
  return ((per_rate > 0.0 ? low + side : low) - from) * per_rate;
}

/// Marches through one tile from parameter `from` to `to`; depth 0 if nothing is hit.
/// @param guess  a parameter near the answer, or 0
[[nodiscard]] GroundHit march_tile(
    const GroundNode& node, const TileRay& ray, double from, double to, double guess);

}  // namespace overfly::renderer::raycast
