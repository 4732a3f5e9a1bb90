// The ray-caster's tiles: packed as the store has them, within a budget, coarser ones for late
// ones.
#include "renderer/raycast/paint/texel_tiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer::raycast {
namespace {

using terrain::TileId;

std::shared_ptr<overfly::testing::ProceduralGround> ramp_ground(int failing_level = -1) {
  overfly::testing::ProceduralGround::Options options;
  options.paint = [](double east_m, double north_m) {
    return 100.0 + 0.02 * east_m + 10.0 * std::sin(north_m);
  };
  options.failing_level = failing_level;
  return std::make_shared<overfly::testing::ProceduralGround>(options);
}

std::shared_ptr<TileStore> store_of(std::shared_ptr<const terrain::TileSource> tiles) {
  return std::make_shared<TileStore>(std::move(tiles), TileStoreOptions{std::size_t{64} << 20U, 0});
}

TEST(PackedTile, HoldsEachTexelAndTheOneBelow) {
  const auto ground = ramp_ground();
  const terrain::Tile tile = ground->tile({0, 3, 2}).value();
  const TilePixels grey = tile_pixels_from(tile, PixelFormat::kGrey8);
  const TilePixels deep = tile_pixels_from(tile, PixelFormat::kRgbLinear);
  const PackedTile narrow = PackedTile::from(grey);
  const PackedTile wide = PackedTile::from(deep);
  EXPECT_EQ(narrow.planes, 1);
  EXPECT_EQ(wide.planes, 3);
  EXPECT_TRUE(wide.wide && !narrow.wide);
  for (int mip = 0; mip < kPackedMips; ++mip) {
    const Image& level = grey.levels[mip];
    const Image16& deep_level = deep.linear_levels[mip];
    EXPECT_EQ(narrow.last_x[mip], level.width_px - 1);
    EXPECT_FLOAT_EQ(narrow.scale_y[mip], level.height_px / 528.0F);
    for (int y = 0; y < level.height_px; y += 3) {
      const int below = std::min(y + 1, level.height_px - 1);
      for (int x = 0; x < level.width_px; x += 5) {
        const std::size_t i = narrow.offset[mip] + y * narrow.stride[mip] + x;
        ASSERT_EQ(narrow.pairs.at(i), level.at(x, y) | level.at(x, below) << 8);
        for (int c = 0; c < 3; ++c) {
          const std::uint32_t pair =
              deep_level.at(x, y, c) | std::uint32_t{deep_level.at(x, below, c)} << 16U;
          ASSERT_EQ(wide.wide_pairs.at(c * wide.plane_elements + i), pair);
        }
      }
    }
  }
  EXPECT_EQ(narrow.bytes(), 2 * narrow.pairs.size());
  EXPECT_TRUE(narrow.has_imagery(-5.0, 900.0));
}

TEST(PackedTile, KnowsTheEdgeOfTheImagery) {
  // Tile (0, 8) lies right of the eight columns of imagery, except for its border of 8 texels.
  const auto ground = ramp_ground();
  const PackedTile edge =
      PackedTile::from(tile_pixels_from(ground->tile({0, 8, 2}).value(), PixelFormat::kGrey8));
  EXPECT_TRUE(edge.has_imagery(4.0, 264.0));
  EXPECT_FALSE(edge.has_imagery(20.0, 264.0));
  EXPECT_FALSE(edge.has_imagery(600.0, 264.0));
}

TEST(TexelTiles, GetsTheTileAndFindsACoarserOneInItsAbsence) {
  // A store with a thread does not read in find().
  const auto store = std::make_shared<TileStore>(ramp_ground(), TileStoreOptions{});
  TexelTiles tiles(store, std::size_t{64} << 20U);
  ASSERT_TRUE(tiles.get({2, 1, 0}, PixelFormat::kGrey8).ok());
  const auto late = tiles.find({0, 6, 1}, PixelFormat::kGrey8);
  ASSERT_TRUE(late.ok());
  EXPECT_EQ(late->id, (TileId{2, 1, 0}));
  // Nothing above it either: the coarsest tile is waited for.
  const auto other = tiles.find({0, 1, 6}, PixelFormat::kGrey8);
  ASSERT_TRUE(other.ok());
  EXPECT_EQ(other->id, (TileId{3, 0, 0}));
  store->wait_until_idle();
  EXPECT_EQ(tiles.find({0, 6, 1}, PixelFormat::kGrey8)->id, (TileId{0, 6, 1}));
  EXPECT_EQ(tiles.find({0, 1, 6}, PixelFormat::kGrey8)->id, (TileId{0, 1, 6}));
}

TEST(TexelTiles, FormatsAreSeparateAndTilesArePackedOnce) {
  const auto ground = ramp_ground();
  TexelTiles tiles(store_of(ground), std::size_t{64} << 20U);
  const auto grey = tiles.get({1, 1, 1}, PixelFormat::kGrey8);
  const auto rgb = tiles.get({1, 1, 1}, PixelFormat::kRgb8);
  ASSERT_TRUE(grey.ok() && rgb.ok());
  EXPECT_EQ(grey->texels->planes, 1);
  EXPECT_EQ(rgb->texels->planes, 3);
  EXPECT_EQ(tiles.get({1, 1, 1}, PixelFormat::kGrey8)->texels, grey->texels);
  EXPECT_EQ(tiles.find({1, 1, 1}, PixelFormat::kGrey8)->texels, grey->texels);
}

TEST(TexelTiles, TrimLetsGoOfTheLeastRecentlyUsed) {
  const auto store = store_of(ramp_ground());
  const std::size_t bytes = PackedTile::from(**store->get({0, 0, 0}, PixelFormat::kGrey8)).bytes();
  TexelTiles tiles(store, 4 * bytes);  // three and a half after trimming
  std::vector<std::shared_ptr<const PackedTile>> first;
  for (int col = 0; col < 4; ++col) {
    first.push_back(tiles.get({0, col, 0}, PixelFormat::kGrey8)->texels);
  }
  ASSERT_EQ(tiles.get({0, 0, 0}, PixelFormat::kGrey8)->texels, first[0]);
  tiles.trim();
  EXPECT_EQ(tiles.get({0, 0, 0}, PixelFormat::kGrey8)->texels, first[0]);
  EXPECT_EQ(tiles.get({0, 2, 0}, PixelFormat::kGrey8)->texels, first[2]);
  EXPECT_NE(tiles.get({0, 1, 0}, PixelFormat::kGrey8)->texels, first[1]) << "it was the oldest";
}

TEST(TexelTiles, PrefetchPacksOneATimeWhileThereIsRoom) {
  const auto store = store_of(ramp_ground());
  const std::size_t bytes = PackedTile::from(**store->get({0, 0, 0}, PixelFormat::kGrey8)).bytes();
  std::vector<TileId> ids;
  for (int col = 0; col < 5; ++col) ids.push_back({0, col, 0});
  for (const TileId& id : ids) ASSERT_TRUE(store->get(id, PixelFormat::kGrey8).ok());
  TexelTiles tiles(store, 4 * bytes);
  int packed = 0;
  while (packed < 10 && tiles.prefetch(ids, PixelFormat::kGrey8)) ++packed;
  EXPECT_GE(packed, 2);
  EXPECT_LE(packed, 3) << "room is left for tiles that a frame waits for";
  TexelTiles roomy(store, 64 * bytes);
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(roomy.prefetch(ids, PixelFormat::kGrey8));
  EXPECT_FALSE(roomy.prefetch(ids, PixelFormat::kGrey8)) << "all are packed";
}

TEST(TexelTiles, NamesATileThatCannotBeRead) {
  TexelTiles tiles(store_of(ramp_ground(1)), std::size_t{64} << 20U);
  const auto missing = tiles.get({1, 2, 3}, PixelFormat::kGrey8);
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, ErrorCode::kIo);
  EXPECT_NE(missing.error().message.find("tile 1/2/3"), std::string::npos);
}

}  // namespace
}  // namespace overfly::renderer::raycast
