#include "server/views/tiles_along.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>

#include "server/record/rows/rows.hpp"

namespace overfly::server {
namespace {

using terrain::TileId;

constexpr std::size_t kMostSamples = 600;
constexpr std::size_t kMostTiles = 4000;
/// Of a level, for a camera that sees the horizon.
constexpr double kMostReachTiles = 3.0;

void add_square(const terrain::TileSource& tiles,
                int level,
                const Eigen::Vector2d& middle_map_m,
                double reach_m,
                std::set<TileId>* ids) {
  const terrain::TileGrid& grid = tiles.grid();
  // A run's record may hold any number: what is not finite or beyond the imagery is left out.
  if (!middle_map_m.allFinite() || !std::isfinite(reach_m)) return;
  const auto index = [&](double way_m, int tiles_of_level_0) {
    const double most = std::ldexp(tiles_of_level_0, -level);
    return static_cast<int>(std::floor(std::clamp(way_m / grid.tile_m(level), -1.0, most)));
  };
  const double right_m = middle_map_m.x() - grid.left_x_m;
  const double down_m = grid.top_y_m - middle_map_m.y();
  const int last_row = index(down_m + reach_m, grid.rows);
  const int last_col = index(right_m + reach_m, grid.cols);
  for (int row = index(down_m - reach_m, grid.rows); row <= last_row; ++row) {
    for (int col = index(right_m - reach_m, grid.cols); col <= last_col; ++col) {
      const TileId id{level, col, row};
      if (ids->contains(id) || tiles.coverage(id) == terrain::TileCoverage::kNone) continue;
      ids->insert(id);
      if (ids->size() >= kMostTiles) return;
    }
  }
}

}  // namespace

std::vector<TileId> tiles_along(const RunTimeline& timeline,
                                const terrain::TileSource& tiles,
                                int finest_level,
                                double reach_per_depth) {
  const std::size_t count = timeline.frame_count();
  const std::size_t step = std::max<std::size_t>(1, count / kMostSamples);
  std::vector<TileId> all;
  for (int level = tiles.grid().levels - 1; level >= finest_level; --level) {
    std::set<TileId> ids;
    for (std::size_t i = 0; i < count && ids.size() < kMostTiles; i += step) {
      const std::vector<FrameRow> rows = timeline.frames(i, 1);
      if (rows.empty() || !rows.front().axis_depth_m) continue;
      const FrameRow& row = rows.front();
      const double depth_m = *row.axis_depth_m;
      const Eigen::Vector3d seen_m = row.T_world_camera * Eigen::Vector3d(0.0, 0.0, depth_m);
      add_square(tiles,
                 level,
                 tiles.map_from_world(seen_m.x(), seen_m.y()),
                 std::min(reach_per_depth * depth_m, kMostReachTiles * tiles.grid().tile_m(level)),
                 &ids);
    }
    all.insert(all.end(), ids.begin(), ids.end());
    if (all.size() >= kMostTiles) break;
  }
  return all;
}

}  // namespace overfly::server
