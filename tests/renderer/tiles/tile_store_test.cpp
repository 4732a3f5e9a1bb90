// Tiles in memory: within a budget, read once, ahead of need, and always the same.
#include "renderer/tiles/tile_store.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include "renderer/tiles/tile_pixels.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

using overfly::testing::ProceduralGround;
using terrain::TileId;

constexpr PixelFormat kFormats[] = {
    PixelFormat::kGrey8, PixelFormat::kRgb8, PixelFormat::kGreyLinear, PixelFormat::kRgbLinear};

std::shared_ptr<ProceduralGround> ground(int failing_level = -1) {
  ProceduralGround::Options options;
  // Cheap to paint: these tests are about the store.
  options.paint = [](double east_m, double north_m) {
    return 60.0 + std::fmod(std::abs(3.0 * east_m + 5.0 * north_m), 150.0);
  };
  options.colourful = true;
  options.failing_level = failing_level;
  return std::make_shared<ProceduralGround>(options);
}

TEST(TileStore, GivesTheTileInEachFormatWithItsMipLevels) {
  const auto tiles = ground();
  TileStore store(tiles, {});
  const terrain::Tile tile = tiles->tile({1, 0, 1}).value();
  for (const PixelFormat format : kFormats) {
    const auto pixels = store.get({1, 0, 1}, format);
    ASSERT_TRUE(pixels.ok()) << pixels.error().message;
    const std::size_t levels = 10;
    EXPECT_EQ((*pixels)->levels.size(), is_linear(format) ? 0 : levels);
    EXPECT_EQ((*pixels)->linear_levels.size(), is_linear(format) ? levels : 0);
  }
  EXPECT_EQ(store.get({1, 0, 1}, PixelFormat::kGrey8).value()->levels[0].data,
            grey_from_rgb(tile.rgb).data);
  EXPECT_EQ(store.get({1, 0, 1}, PixelFormat::kRgb8).value()->levels[0].data,
            with_alpha(tile.rgb, tile.valid).data);
}

TEST(TileStore, AveragesLinearTexelsInLinearLight) {
  // Black and white in equal parts: half the light, not half the code.
  terrain::Tile tile{Image(2, 2, 3), Image(2, 2, 1, 255)};
  tile.rgb.data = {0, 0, 0, 255, 255, 255, 255, 255, 255, 0, 0, 0};
  const TilePixels grey = tile_pixels_from(tile, PixelFormat::kGreyLinear);
  EXPECT_NEAR(grey.linear_levels[1].at(0, 0), 32767.5, 1.0);
  const TilePixels rgb = tile_pixels_from(tile, PixelFormat::kRgbLinear);
  EXPECT_NEAR(rgb.linear_levels[1].at(0, 0, 1), 32767.5, 1.0);
  EXPECT_EQ(rgb.linear_levels[1].at(0, 0, 3), 65535);
  EXPECT_NEAR(tile_pixels_from(tile, PixelFormat::kGrey8).levels[1].at(0, 0), 127.5, 1.0);
}

TEST(TileStore, UndoesTheTransferFunctionOfSrgb) {
  // Published pairs of IEC 61966-2-1: code 188 is about half the light, 118 about 18 %.
  const auto& linear = linear_from_srgb();
  EXPECT_EQ(linear[0], 0);
  EXPECT_EQ(linear[255], 65535);
  EXPECT_NEAR(linear[188] / 65535.0, 0.5029, 1e-4);
  EXPECT_NEAR(linear[118] / 65535.0, 0.1812, 1e-4);
  EXPECT_NEAR(linear[10] / 65535.0, 10.0 / 255.0 / 12.92, 1e-5);
  Image rgb(256, 1, 3);
  for (int i = 0; i < 256; ++i) {
    for (int c = 0; c < 3; ++c) rgb.at(i, 0, c) = static_cast<std::uint8_t>(i);
  }
  const Image16 grey = linear_grey_from_rgb(rgb);
  for (int i = 0; i < 256; ++i) EXPECT_EQ(grey.at(i, 0), linear[i]);
}

TEST(TileStore, KeepsWhatWasUsedLastWithinItsBudget) {
  const auto tiles = ground();
  const std::size_t tile_bytes = TileStore(tiles, {std::size_t{64} << 20U, 0})
                                     .get({0, 0, 0}, PixelFormat::kGrey8)
                                     .value()
                                     ->bytes();
  TileStore store(tiles, {3 * tile_bytes, 0});
  for (int col = 0; col < 3; ++col) ASSERT_TRUE(store.get({0, col, 0}, PixelFormat::kGrey8).ok());
  const auto in_use = store.get({0, 0, 0}, PixelFormat::kGrey8).value();
  ASSERT_TRUE(store.get({0, 3, 0}, PixelFormat::kGrey8).ok());
  EXPECT_EQ(store.held_bytes(), 3 * tile_bytes);
  EXPECT_EQ(store.peek({0, 1, 0}, PixelFormat::kGrey8), nullptr);
  EXPECT_EQ(store.peek({0, 0, 0}, PixelFormat::kGrey8), in_use);
  // What someone draws from outlives the store's interest in it, with the same texels.
  const std::vector<std::uint8_t> texels = in_use->levels[0].data;
  for (int row = 1; row < 6; ++row) ASSERT_TRUE(store.get({0, 0, row}, PixelFormat::kGrey8).ok());
  EXPECT_EQ(store.peek({0, 0, 0}, PixelFormat::kGrey8), nullptr);
  EXPECT_EQ(in_use->levels[0].data, texels);
  EXPECT_EQ(store.get({0, 0, 0}, PixelFormat::kGrey8).value()->levels[0].data, texels);
}

TEST(TileStore, ReadsATileOnceForManyCallers) {
  const auto tiles = ground();
  TileStore store(tiles, {std::size_t{64} << 20U, 2});
  std::vector<std::shared_ptr<const TilePixels>> got(6);
  std::vector<std::thread> threads;
  for (auto& pixels : got) {
    threads.emplace_back([&] { pixels = store.get({0, 2, 2}, PixelFormat::kGrey8).value(); });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(tiles->tiles_read(), 1);
  for (const auto& pixels : got) EXPECT_EQ(pixels, got[0]);
}

TEST(TileStore, FetchesAheadWhatItIsAskedFor) {
  const auto tiles = ground();
  TileStore store(tiles, {});
  const std::vector<TileId> ids{{0, 1, 1}, {0, 2, 1}, {1, 0, 0}};
  store.prefetch(ids, PixelFormat::kGrey8);
  store.wait_until_idle();
  for (const TileId& id : ids) EXPECT_NE(store.peek(id, PixelFormat::kGrey8), nullptr);
  EXPECT_EQ(store.counts().read_ahead, 3);
  EXPECT_EQ(store.counts().read_on_demand, 0);
  ASSERT_TRUE(store.get({0, 2, 1}, PixelFormat::kGrey8).ok());
  EXPECT_EQ(tiles->tiles_read(), 3);
}

TEST(TileStore, FindReturnsAtOnceAndAsksForTheTile) {
  TileStore store(ground(), {});
  EXPECT_EQ(store.peek({0, 1, 1}, PixelFormat::kGrey8), nullptr);
  (void)store.find({0, 1, 1}, PixelFormat::kGrey8);
  store.wait_until_idle();
  EXPECT_NE(store.find({0, 1, 1}, PixelFormat::kGrey8), nullptr);
  TileStore threadless(ground(), {std::size_t{64} << 20U, 0});
  EXPECT_NE(threadless.find({0, 1, 1}, PixelFormat::kGrey8), nullptr);
}

TEST(TileStore, FetchingAheadLeavesRoomForWhatIsInUse) {
  const auto tiles = ground();
  const std::size_t tile_bytes =
      tile_pixels_from(tiles->tile({0, 0, 0}).value(), PixelFormat::kGrey8).bytes();
  TileStore store(tiles, {3 * tile_bytes, 1});
  for (int col = 0; col < 2; ++col) ASSERT_TRUE(store.get({0, col, 0}, PixelFormat::kGrey8).ok());
  store.prefetch(std::vector<TileId>{{0, 2, 0}, {0, 3, 0}, {0, 4, 0}}, PixelFormat::kGrey8);
  store.wait_until_idle();
  EXPECT_NE(store.peek({0, 0, 0}, PixelFormat::kGrey8), nullptr);
  EXPECT_NE(store.peek({0, 1, 0}, PixelFormat::kGrey8), nullptr);
  EXPECT_NE(store.peek({0, 2, 0}, PixelFormat::kGrey8), nullptr);
  EXPECT_LE(store.held_bytes(), 3 * tile_bytes);
}

/// Waits in the first call of each thread until two threads have called.
class Rendezvous {
 public:
  void arrive() {
    std::unique_lock lock(mutex_);
    if (!threads_.insert(std::this_thread::get_id()).second) return;
    arrived_.notify_all();
    arrived_.wait_for(lock, std::chrono::seconds(60), [this] { return threads_.size() > 1; });
  }
  std::size_t threads() {
    const std::lock_guard lock(mutex_);
    return threads_.size();
  }

 private:
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::set<std::thread::id> threads_;
};

TEST(TileStore, LoadsSeveralTilesAtOnceAndEachOnce) {
  Rendezvous both;
  ProceduralGround::Options options;
  options.paint = [&](double, double) {
    both.arrive();
    return 60.0;
  };
  const auto tiles = std::make_shared<ProceduralGround>(options);
  TileStore store(tiles, {});
  const std::vector<TileId> ids{{0, 1, 1}, {0, 2, 1}, {0, 1, 1}, {1, 0, 0}, {0, 3, 1}};
  store.load(ids, PixelFormat::kGrey8);
  EXPECT_EQ(both.threads(), 2U);
  for (const TileId& id : ids) EXPECT_TRUE(store.get(id, PixelFormat::kGrey8).ok());
  EXPECT_EQ(tiles->tiles_read(), 4);
  EXPECT_GE(store.counts().read_on_demand, 1);
  store.load(ids, PixelFormat::kGrey8);
  EXPECT_EQ(tiles->tiles_read(), 4);
}

TEST(TileStore, LoadsUntilItsLimitAndLeavesTheRestToItsThreads) {
  const auto tiles = ground();
  TileStore store(tiles, {});
  const std::vector<TileId> ids{{0, 1, 1}, {0, 2, 1}, {1, 0, 0}};
  store.load(ids, PixelFormat::kGrey8, 0);
  EXPECT_EQ(store.counts().read_on_demand, 0);
  store.wait_until_idle();
  for (const TileId& id : ids) EXPECT_NE(store.peek(id, PixelFormat::kGrey8), nullptr);
  EXPECT_EQ(store.counts().read_ahead, 3);
}

TEST(TileStore, WithoutThreadsALimitLeavesNothingBehind) {
  TileStore store(ground(), {std::size_t{64} << 20U, 0});
  const std::vector<TileId> ids{{0, 1, 1}, {0, 2, 1}};
  store.load(ids, PixelFormat::kGrey8, 0);
  store.wait_until_idle();
  EXPECT_NE(store.find(ids.front(), PixelFormat::kGrey8), nullptr);
}

TEST(TileStore, ReportsWhatCouldNotBeLoadedWhenItIsWanted) {
  TileStore store(ground(0), {});
  store.load(std::vector<TileId>{{0, 3, 2}, {0, 4, 2}}, PixelFormat::kGrey8);
  EXPECT_EQ(store.get({0, 3, 2}, PixelFormat::kGrey8).error().code, ErrorCode::kIo);
  store.wait_until_idle();
}

TEST(TileStore, ReadsWhenIdleOnlyWhatEvictsNothing) {
  const auto tiles = ground();
  const std::size_t tile_bytes =
      tile_pixels_from(tiles->tile({0, 0, 0}).value(), PixelFormat::kGrey8).bytes();
  TileStore store(tiles, {3 * tile_bytes, 1});
  ASSERT_TRUE(store.get({0, 0, 0}, PixelFormat::kGrey8).ok());
  store.read_when_idle(std::vector<TileId>{{0, 1, 0}, {0, 2, 0}, {0, 3, 0}, {0, 4, 0}},
                       PixelFormat::kGrey8);
  store.wait_until_idle();
  for (const int col : {0, 1, 2}) {
    EXPECT_NE(store.peek({0, col, 0}, PixelFormat::kGrey8), nullptr) << col;
  }
  for (const int col : {3, 4}) {
    EXPECT_EQ(store.peek({0, col, 0}, PixelFormat::kGrey8), nullptr) << col;
  }
  for (int i = 0; i < 2; ++i) {
    store.prefetch(std::vector<TileId>{{0, 5, 0}}, PixelFormat::kGrey8);
    store.wait_until_idle();
  }
  EXPECT_NE(store.peek({0, 5, 0}, PixelFormat::kGrey8), nullptr) << "more urgent";
}

TEST(TileStore, NamesATileThatCannotBeRead) {
  TileStore store(ground(0), {});
  store.prefetch(std::vector<TileId>{{0, 3, 2}}, PixelFormat::kGrey8);
  store.wait_until_idle();
  const auto pixels = store.get({0, 3, 2}, PixelFormat::kGrey8);
  ASSERT_FALSE(pixels.ok());
  EXPECT_EQ(pixels.error().code, ErrorCode::kIo);
  EXPECT_NE(pixels.error().message.find("tile 0/3/2"), std::string::npos);
  EXPECT_NE(pixels.error().message.find("the disk is gone"), std::string::npos);
}

TEST(TileStore, KnowsWhereThereIsImagery) {
  terrain::Tile tile{Image(528, 528, 3), Image(528, 528, 1)};
  for (int y = 0; y < 528; ++y) {
    for (int x = 0; x < 264; ++x) tile.valid.at(x, y) = 255;
  }
  const TilePixels half = tile_pixels_from(tile, PixelFormat::kGrey8);
  EXPECT_TRUE(half.has_imagery(0.4, 0.9));
  EXPECT_FALSE(half.has_imagery(0.6, 0.1));
  tile.valid = Image(528, 528, 1, 255);
  EXPECT_TRUE(tile_pixels_from(tile, PixelFormat::kGrey8).has_imagery(0.6, 0.1));
}

}  // namespace
}  // namespace overfly::renderer
