// What could not be read, of a world that several use at the same time.
#include "server/camera/watched_tiles.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "tests/terrain/decoration/analytic_tiles.hpp"

namespace overfly::server {
namespace {

/// Flat ground whose heights in the east cannot be read.
std::shared_ptr<const terrain::TileSource> damaged_in_the_east() {
  return std::make_shared<overfly::testing::AnalyticTiles>(
      1.0,
      1,
      [](double east_m, double) {
        if (east_m > 100.0) terrain::HeightErrors::add({ErrorCode::kIo, "a damaged block"});
        return 5.0;
      },
      Eigen::Vector2d(5.0, 5.0),
      [](int, int) { return 100; });
}

TEST(WatchedTiles, HaveNoErrorsOfHeightsThatOthersCouldNotRead) {
  const auto world = damaged_in_the_east();
  const WatchedTiles viewer(world, nullptr);
  const WatchedTiles run(world, nullptr);
  EXPECT_EQ(viewer.ground_up_m(50.0, 0.0), 5.0);
  EXPECT_TRUE(viewer.status());
  EXPECT_EQ(viewer.ground_up_m(150.0, 0.0), 5.0);
  EXPECT_EQ(run.ground_up_m(50.0, 0.0), 5.0);
  ASSERT_FALSE(viewer.status());
  EXPECT_EQ(viewer.status().error().message, "a damaged block");
  ASSERT_FALSE(viewer.tile({}));
  EXPECT_EQ(viewer.tile({}).error().code, ErrorCode::kIo);
  EXPECT_TRUE(run.status());
  EXPECT_TRUE(run.tile({}));
}

TEST(WatchedTiles, EveryQueryOfAHeightIsWatched) {
  const auto world = damaged_in_the_east();
  const Eigen::Vector2d place(150.0, 0.0);
  using Query = std::function<void(const WatchedTiles&)>;
  for (const Query& query :
       {Query([&](const WatchedTiles& tiles) { (void)tiles.world_from_map(150.0, 0.0); }),
        Query(
            [&](const WatchedTiles& tiles) { (void)tiles.coarse_world_from_map(150.0, 0.0, 8.0); }),
        Query([&](const WatchedTiles& tiles) {
          (void)tiles.coarse_world_at({&place, 1}, 8.0);
        }),
        Query([&](const WatchedTiles& tiles) { (void)tiles.ground_up_m(150.0, 0.0); })}) {
    const WatchedTiles tiles(world, nullptr);
    query(tiles);
    EXPECT_FALSE(tiles.status());
  }
}

}  // namespace
}  // namespace overfly::server
