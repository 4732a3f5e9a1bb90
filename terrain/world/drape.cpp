#include "terrain/world/drape.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace overfly::terrain {

double drape_stretch(const Eigen::Vector3d& normal) {
  constexpr double kSteepest = 1e6;
  const double up = std::abs(normal.z());
  const double length = normal.norm();
  return up * kSteepest <= length ? kSteepest : length / up;
}

double drape_stretch(const TileSource& tiles, double x_map_m, double y_map_m) {
  const double step_m = std::max(0.1, 0.25 * tiles.real_texel_m());
  const Eigen::Vector3d east = tiles.world_from_map(x_map_m + step_m, y_map_m) -
                               tiles.world_from_map(x_map_m - step_m, y_map_m);
  const Eigen::Vector3d north = tiles.world_from_map(x_map_m, y_map_m + step_m) -
                                tiles.world_from_map(x_map_m, y_map_m - step_m);
  return drape_stretch(Eigen::Vector3d(east.cross(north)));
}

double stretched_share(const TileSource& tiles, double limit, int samples) {
  const TileGrid& grid = tiles.grid();
  int seen = 0;
  int stretched = 0;
  for (int row = 0; row < samples; ++row) {
    for (int column = 0; column < samples; ++column) {
      const double x_map_m = grid.left_x_m + grid.width_m * (column + 0.5) / samples;
      const double y_map_m = grid.top_y_m - grid.height_m * (row + 0.5) / samples;
      if (!tiles.has_imagery(x_map_m, y_map_m)) continue;
      ++seen;
      stretched += drape_stretch(tiles, x_map_m, y_map_m) > limit ? 1 : 0;
    }
  }
  return seen == 0 ? 0.0 : static_cast<double>(stretched) / seen;
}

}  // namespace overfly::terrain
