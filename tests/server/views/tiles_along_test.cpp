// The ground below a flight, as tiles.
#include "server/views/tiles_along.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/server/support/manager_fixture.hpp"

namespace overfly::server {
namespace {

using terrain::TileId;

/// With the ray-caster, which measures the depth of the ground and needs no OpenGL.
class TilesAlong : public testing::ManagerTest {
 protected:
  TilesAlong() {
    RunManagerOptions drawn = options();
    drawn.renderer_factory = {};
    runs_ = std::move(RunManager::create(drawn).value());
    // Larger than the small world, which has one level.
    const nlohmann::json world = {{"builtin", {{"seed", 1}}}};
    id_ = runs_->start("small", {{"renderer.camera", "raycast"}, {"world", world}}).value().id;
    EXPECT_EQ(wait_for_end(*runs_, id_).status, RunStatus::kCompleted);
    world_ = runs_->world_of(id_, [] { return false; }).value();
  }

  std::unique_ptr<RunManager> runs_;
  std::string id_;
  std::shared_ptr<const terrain::World> world_;
};

TEST_F(TilesAlong, HoldsTheGroundInTheMiddleOfEachFrame) {
  const auto timeline = runs_->timeline(id_).value();
  const terrain::TileSource& tiles = *world_->tiles;
  constexpr int kFinest = 1;
  const std::vector<TileId> ids = tiles_along(*timeline, tiles, kFinest, 1.0);
  ASSERT_FALSE(ids.empty());
  EXPECT_TRUE(std::is_sorted(
      ids.begin(), ids.end(), [](const TileId& a, const TileId& b) { return a.level > b.level; }));
  const terrain::TileGrid& grid = tiles.grid();
  std::size_t checked = 0;
  for (std::size_t i = 0; i < timeline->frame_count(); ++i) {
    const FrameRow row = timeline->frames(i, 1).front();
    if (!row.axis_depth_m) continue;
    const Eigen::Vector3d seen_m =
        row.T_world_camera * Eigen::Vector3d(0.0, 0.0, *row.axis_depth_m);
    const Eigen::Vector2d map_m = tiles.map_from_world(seen_m.x(), seen_m.y());
    for (int level = kFinest; level < grid.levels; ++level) {
      const TileId below{
          level,
          static_cast<int>(std::floor((map_m.x() - grid.left_x_m) / grid.tile_m(level))),
          static_cast<int>(std::floor((grid.top_y_m - map_m.y()) / grid.tile_m(level)))};
      EXPECT_THAT(ids, ::testing::Contains(below)) << "frame " << i << ", level " << level;
      ++checked;
    }
  }
  EXPECT_GT(checked, 10U);
  for (const TileId& tile : ids) {
    EXPECT_GE(tile.level, kFinest);
    EXPECT_NE(tiles.coverage(tile), terrain::TileCoverage::kNone);
  }
}

TEST_F(TilesAlong, IsEmptyForAFlightWithoutFrames) {
  EXPECT_TRUE(tiles_along(RunTimeline(RunInfo{}, {}), *world_->tiles, 0, 1.0).empty());
}

}  // namespace
}  // namespace overfly::server
