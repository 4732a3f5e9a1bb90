// Where a ray meets the ground.
#pragma once

#include <Eigen/Core>

#include "renderer/raycast/ground/height_field.hpp"

namespace overfly::renderer::raycast {

/// The bilinear surface of a tile's cell: h = sw + a e + b n + c e n over (e, n) in [0, 1]^2.
struct CellSurface {
  double sw, a, b, c;

  CellSurface(const HeightTile& tile, int column, int row) {
    sw = tile.height(column, row);
    a = tile.height(column + 1, row) - sw;
    b = tile.height(column, row + 1) - sw;
    c = tile.height(column + 1, row + 1) - sw - a - b;
  }
};

struct GroundHit {
  double depth = 0.0;  ///< the ray's parameter: origin + depth * direction; 0 = the sky
  const GroundNode* node = nullptr;
  int column = 0, row = 0;        ///< cell of the node's tile
  double across = 0.0, up = 0.0;  ///< place in the cell, east and north, in [0, 1]

  [[nodiscard]] bool sky() const { return node == nullptr; }
  /// Place on the map, in texels of level 0.
  [[nodiscard]] Eigen::Vector2d texel() const;
  /// d(height) / d(east, north).
  [[nodiscard]] Eigen::Vector2d slope() const;
  /// d(texel) / d(east, north).
  [[nodiscard]] Eigen::Matrix2d texels_per_m() const;
};

}  // namespace overfly::renderer::raycast
