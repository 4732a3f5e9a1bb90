#include "renderer/raycast/ground/ground_hit.hpp"

namespace overfly::renderer::raycast {

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
  const CellSurface cell(*node->tile, column, row);
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

}  // namespace overfly::renderer::raycast
