#include "server/worlds/world_extent.hpp"

#include <Eigen/Core>
#include <array>

namespace overfly::server {

WorldExtent extent_of(const terrain::World& world) {
  const terrain::TileSource& tiles = *world.tiles;
  const terrain::TileGrid& grid = tiles.grid();
  const auto place = [&](double right, double down) {
    return tiles.frame().geodetic_from_world(tiles.world_from_map(
        grid.left_x_m + right * grid.width_m, grid.top_y_m - down * grid.height_m));
  };
  WorldExtent extent{world.spec.name, tiles.attribution(), place(0.5, 0.5), {}};
  // A side of the map plane is no straight line on another map.
  constexpr int kSteps = 8;
  const std::array<Eigen::Vector2d, 5> corners = {
      Eigen::Vector2d{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}, {0.0, 0.0}};
  for (std::size_t side = 0; side < 4; ++side) {
    for (int step = 0; step < kSteps; ++step) {
      const Eigen::Vector2d at =
          corners[side] + static_cast<double>(step) / kSteps * (corners[side + 1] - corners[side]);
      extent.outline.push_back(place(at.x(), at.y()));
    }
  }
  return extent;
}

}  // namespace overfly::server
