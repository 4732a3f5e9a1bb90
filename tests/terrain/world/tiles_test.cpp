#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <future>
#include <thread>
#include <utility>

#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/support/synthetic_world.hpp"

namespace overfly::terrain {
namespace {

using testing::GeoTiff;
using testing::TemporaryFolder;

World open_images(const std::vector<std::filesystem::path>& files) {
  WorldSpec spec;
  for (const auto& file : files) spec.imagery.push_back({file, "", {}});
  spec.ground_height_m = 100.0;
  auto world = open_world(spec);
  if (!world) throw std::runtime_error(world.error().message);
  return std::move(*world);
}

GeoTiff textured(int width_px, int height_px, int channels = 3) {
  GeoTiff tiff;
  tiff.image = testing::textured_image(width_px, height_px, channels);
  tiff.left = 583000.0;
  tiff.top = 4357000.0;
  tiff.pixel = 0.5;
  return tiff;
}

Tile read(const World& world, int level, int col, int row) {
  auto tile = world.tiles->tile({level, col, row});
  if (!tile) throw std::runtime_error(tile.error().message);
  return std::move(*tile);
}

/// Every border texel of a tile is the texel of the neighbour that it repeats.
void expect_borders_agree(const World& world, int level) {
  const Tile tile = read(world, level, 0, 0);
  const Tile east = read(world, level, 1, 0);
  const Tile south = read(world, level, 0, 1);
  int different = 0;
  for (int along = 0; along < kTileSide; ++along) {
    for (int across = 0; across < 2 * kTileBorder; ++across) {
      for (int c = 0; c < 3; ++c) {
        different += tile.rgb.at(kTileTexels + across, along, c) != east.rgb.at(across, along, c);
        different += tile.rgb.at(along, kTileTexels + across, c) != south.rgb.at(along, across, c);
      }
      different += tile.valid.at(kTileTexels + across, along) != east.valid.at(across, along);
      different += tile.valid.at(along, kTileTexels + across) != south.valid.at(along, across);
    }
  }
  EXPECT_EQ(different, 0) << "level " << level;
}

/// Mean absolute difference between a level-L+1 tile and the area average of level L, and the
/// mean signed one, over the first tile's north-west quarter, 4 texels off its rim.
struct Agreement {
  double absolute = 0.0;
  double shift_x = 0.0;  ///< least-squares displacement [coarse texels]
  double shift_y = 0.0;
};
Agreement compare_levels(const World& world, int level) {
  const Tile fine = read(world, level, 0, 0);
  const Tile coarse = read(world, level + 1, 0, 0);
  const int half = kTileTexels / 2;
  ImageBuffer<double> average(half, half, 1);
  for (int y = 0; y < half; ++y) {
    for (int x = 0; x < half; ++x) {
      double sum = 0.0;
      for (int i = 0; i < 4; ++i) {
        sum += fine.rgb.at(kTileBorder + 2 * x + i % 2, kTileBorder + 2 * y + i / 2, 1);
      }
      average.at(x, y) = sum / 4.0;
    }
  }
  Agreement result;
  double xx = 0;
  double yy = 0;
  double xy = 0;
  double xe = 0;
  double ye = 0;
  int count = 0;
  for (int y = 4; y < half - 4; ++y) {
    for (int x = 4; x < half - 4; ++x) {
      if (coarse.valid.at(kTileBorder + x, kTileBorder + y) == 0) continue;
      const double error = coarse.rgb.at(kTileBorder + x, kTileBorder + y, 1) - average.at(x, y);
      const double gx = 0.5 * (average.at(x + 1, y) - average.at(x - 1, y));
      const double gy = 0.5 * (average.at(x, y + 1) - average.at(x, y - 1));
      result.absolute += std::abs(error);
      xx += gx * gx;
      yy += gy * gy;
      xy += gx * gy;
      xe += gx * error;
      ye += gy * error;
      ++count;
    }
  }
  result.absolute /= count;
  const double determinant = xx * yy - xy * xy;
  result.shift_x = -(yy * xe - xy * ye) / determinant;
  result.shift_y = -(xx * ye - xy * xe) / determinant;
  return result;
}

TEST(Tiles, OfANativeGridAreTheFilesTexels) {
  TemporaryFolder folder;
  const GeoTiff tiff = textured(700, 600);
  testing::write_geotiff(folder.path() / "a.tif", tiff);
  const World world = open_images({folder.path() / "a.tif"});
  const TileGrid& grid = world.tiles->grid();
  EXPECT_DOUBLE_EQ(grid.left_x_m, tiff.left);
  EXPECT_DOUBLE_EQ(grid.top_y_m, tiff.top);
  EXPECT_DOUBLE_EQ(grid.texel_m, 0.5);
  EXPECT_EQ(grid.cols, 2);
  EXPECT_EQ(grid.rows, 2);
  EXPECT_EQ(grid.levels, 2);
  const Tile tile = read(world, 0, 1, 1);
  for (int y = 0; y < kTileSide; ++y) {
    for (int x = 0; x < kTileSide; ++x) {
      const int px = kTileTexels - kTileBorder + x;
      const int py = kTileTexels - kTileBorder + y;
      const bool inside = px < 700 && py < 600;
      ASSERT_EQ(tile.valid.at(x, y), inside ? 255 : 0) << x << ' ' << y;
      for (int c = 0; c < 3; ++c) {
        ASSERT_EQ(tile.rgb.at(x, y, c), inside ? tiff.image.at(px, py, c) : kVoidRgb[c]);
      }
    }
  }
}

TEST(Tiles, OfGreyImageryHaveThreeEqualChannels) {
  TemporaryFolder folder;
  const GeoTiff tiff = textured(600, 520, 1);
  testing::write_geotiff(folder.path() / "a.tif", tiff);
  const Tile tile = read(open_images({folder.path() / "a.tif"}), 0, 0, 0);
  for (int c = 0; c < 3; ++c) EXPECT_EQ(tile.rgb.at(100, 50, c), tiff.image.at(92, 42));
}

TEST(Tiles, AgreeAcrossBordersOnEveryLevel) {
  TemporaryFolder folder;
  GeoTiff tiff = textured(1300, 1200);
  tiff.jpeg = true;
  tiff.overviews = 2;
  testing::write_geotiff(folder.path() / "a.tif", tiff);
  const World world = open_images({folder.path() / "a.tif"});
  for (int level = 0; level < 3; ++level) expect_borders_agree(world, level);
}

TEST(Tiles, OfResampledImageryAgreeAcrossBorders) {
  TemporaryFolder folder;
  GeoTiff tiff = textured(1500, 1500);
  tiff.crs = "EPSG:4326";
  tiff.left = -86.03;
  tiff.top = 39.35;
  tiff.pixel = 5e-6;
  testing::write_geotiff(folder.path() / "a.tif", tiff);
  const World world = open_images({folder.path() / "a.tif"});
  for (int level = 0; level < 2; ++level) expect_borders_agree(world, level);
}

TEST(Tiles, OfCoarserLevelsAreAreaAveragesWithoutShift) {
  TemporaryFolder folder;
  // Odd sizes, with overviews that do not fit powers of two exactly, and without any.
  for (const int overviews : {0, 3}) {
    GeoTiff tiff = textured(1345, 1111);
    tiff.overviews = overviews;
    const auto file = folder.path() / (std::to_string(overviews) + ".tif");
    testing::write_geotiff(file, tiff);
    const World world = open_images({file});
    for (int level = 0; level + 1 < world.tiles->grid().levels; ++level) {
      const Agreement agreement = compare_levels(world, level);
      // Half a grey level is the rounding of 8 bits twice; overviews of odd sizes have texels that
      // lie off the powers of two, and their averages blur a little.
      EXPECT_LT(agreement.absolute, overviews == 0 ? 0.6 : 1.5) << overviews << " level " << level;
      EXPECT_LT(std::abs(agreement.shift_x), 0.02) << overviews << " level " << level;
      EXPECT_LT(std::abs(agreement.shift_y), 0.02) << overviews << " level " << level;
    }
  }
}

TEST(Tiles, OfALargeImageWithoutOverviewsCanBeCancelled) {
  TemporaryFolder folder;
  testing::write_geotiff(folder.path() / "a.tif", textured(1345, 1111));
  const World world = open_images({folder.path() / "a.tif"});
  const TileId coarsest{world.tiles->grid().levels - 1, 0, 0};
  int polls = 0;
  const auto cancelled = world.tiles->tile(coarsest, [&] { return ++polls == 2; });
  ASSERT_FALSE(cancelled.ok());
  EXPECT_EQ(cancelled.error().code, ErrorCode::kCancelled);
  EXPECT_THAT(cancelled.error().message, ::testing::HasSubstr("a.tif: reading it was cancelled"));
  EXPECT_EQ(polls, 2);
  // Other users of the world read on.
  const Tile tile = read(world, coarsest.level, 0, 0);
  const World another = open_images({folder.path() / "a.tif"});
  EXPECT_EQ(tile.rgb.data, read(another, coarsest.level, 0, 0).rgb.data);
}

TEST(Tiles, OfALargeImageAreNotWaitedForByWhoeverIsCancelled) {
  TemporaryFolder folder;
  testing::write_geotiff(folder.path() / "a.tif", textured(1345, 1111));
  const World world = open_images({folder.path() / "a.tif"});
  const TileId coarsest{world.tiles->grid().levels - 1, 0, 0};
  std::promise<void> begun;
  std::promise<void> let_go;
  auto first = std::async(std::launch::async, [&] {
    bool waited = false;
    return world.tiles->tile(coarsest, [&] {
      if (!std::exchange(waited, true)) {
        begun.set_value();
        let_go.get_future().wait();
      }
      return false;
    });
  });
  begun.get_future().wait();
  const auto second = world.tiles->tile(coarsest, [] { return true; });
  let_go.set_value();
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(second.error().code, ErrorCode::kCancelled);
  EXPECT_TRUE(first.get().ok());
}

TEST(Tiles, OfRealImageryAreAreaAveragesWithoutShift) {
  for (const char* name : {"terrain/autzen/ortho_epsg2994_ft.tif",
                           "terrain/mcmillan/ortho_0.8m_utm10.tif",
                           "terrain/goleta/ortho_epsg4326.tif"}) {
    OVERFLY_DATA_OR_SKIP(file, name);
    const World world = open_images({file});
    for (int level = 0; level + 1 < world.tiles->grid().levels; ++level) {
      const Agreement agreement = compare_levels(world, level);
      EXPECT_LT(agreement.absolute, 2.0) << name << " level " << level;
      EXPECT_LT(std::abs(agreement.shift_x), 0.03) << name << " level " << level;
      EXPECT_LT(std::abs(agreement.shift_y), 0.03) << name << " level " << level;
    }
  }
}

TEST(Tiles, ReadTheMaskAndPaintVoids) {
  TemporaryFolder folder;
  GeoTiff tiff = textured(600, 600);
  tiff.valid = Image(600, 600, 1, 255);
  for (int y = 100; y < 200; ++y) {
    for (int x = 300; x < 450; ++x) tiff.valid.at(x, y) = 0;
  }
  testing::write_geotiff(folder.path() / "a.tif", tiff);
  const World world = open_images({folder.path() / "a.tif"});
  const Tile tile = read(world, 0, 0, 0);
  EXPECT_EQ(tile.valid.at(kTileBorder + 350, kTileBorder + 150), 0);
  EXPECT_EQ(tile.rgb.at(kTileBorder + 350, kTileBorder + 150, 2), kVoidRgb[2]);
  EXPECT_EQ(tile.valid.at(kTileBorder + 299, kTileBorder + 150), 255);
  EXPECT_EQ(tile.valid.at(kTileBorder + 300, kTileBorder + 150), 0);
  EXPECT_FALSE(world.tiles->has_imagery(tiff.left + 175.0, tiff.top - 75.0));
  EXPECT_TRUE(world.tiles->has_imagery(tiff.left + 145.0, tiff.top - 75.0));
  EXPECT_FALSE(world.tiles->has_imagery(tiff.left - 1.0, tiff.top - 75.0));
  EXPECT_EQ(world.tiles->coverage({0, 0, 0}), TileCoverage::kPartial);
  EXPECT_EQ(world.tiles->coverage({0, 5, 0}), TileCoverage::kNone);
}

TEST(Tiles, OfAFullFileAreFull) {
  TemporaryFolder folder;
  testing::write_geotiff(folder.path() / "a.tif", textured(1100, 1030));
  const World world = open_images({folder.path() / "a.tif"});
  EXPECT_EQ(world.tiles->coverage({0, 0, 0}), TileCoverage::kFull);
  EXPECT_EQ(world.tiles->coverage({0, 2, 2}), TileCoverage::kPartial);
  EXPECT_EQ(world.tiles->coverage({0, -1, 0}), TileCoverage::kNone);
  EXPECT_EQ(world.tiles->coverage({0, 3, 0}), TileCoverage::kNone);
}

TEST(Tiles, PixelIsPointAndPixelIsAreaMeanTheSamePlace) {
  TemporaryFolder folder;
  GeoTiff tiff = textured(520, 520);
  testing::write_geotiff(folder.path() / "area.tif", tiff);
  tiff.pixel_is_point = true;
  testing::write_geotiff(folder.path() / "point.tif", tiff);
  const World area = open_images({folder.path() / "area.tif"});
  const World point = open_images({folder.path() / "point.tif"});
  EXPECT_DOUBLE_EQ(area.tiles->grid().left_x_m, point.tiles->grid().left_x_m);
  EXPECT_DOUBLE_EQ(area.tiles->grid().top_y_m, point.tiles->grid().top_y_m);
  EXPECT_EQ(read(area, 0, 0, 0).rgb.data, read(point, 0, 0, 0).rgb.data);
}

TEST(Tiles, OfASecondLayerFillTheGapsOfTheFirst) {
  TemporaryFolder folder;
  GeoTiff first = textured(400, 600);
  GeoTiff second = textured(900, 600);
  second.image = testing::textured_image(900, 600, 3, 9);
  testing::write_geotiff(folder.path() / "a.tif", first);
  testing::write_geotiff(folder.path() / "b.tif", second);
  const World world = open_images({folder.path() / "a.tif", folder.path() / "b.tif"});
  const Tile tile = read(world, 0, 0, 0);
  EXPECT_EQ(tile.rgb.at(kTileBorder + 100, kTileBorder + 50), first.image.at(100, 50));
  EXPECT_EQ(tile.valid.at(kTileBorder + 450, kTileBorder + 50), 255);
  // The same grid resampled: the cubic passes through the texels.
  EXPECT_NEAR(tile.rgb.at(kTileBorder + 450, kTileBorder + 50), second.image.at(450, 50), 1);
}

TEST(Tiles, KeepTheFirstLayersTexelsWhenALaterOneReachesFartherWest) {
  TemporaryFolder folder;
  GeoTiff first = textured(700, 700);
  GeoTiff second = textured(700, 700);
  second.left -= 133.0;
  second.top += 77.0;
  testing::write_geotiff(folder.path() / "a.tif", first);
  testing::write_geotiff(folder.path() / "b.tif", second);
  const World world = open_images({folder.path() / "a.tif", folder.path() / "b.tif"});
  const TileGrid& grid = world.tiles->grid();
  const int col = static_cast<int>(std::lround((first.left - grid.left_x_m) / grid.texel_m));
  const int row = static_cast<int>(std::lround((grid.top_y_m - first.top) / grid.texel_m));
  ASSERT_GE(col, 266);
  ASSERT_GE(row, 154);
  EXPECT_NEAR(grid.left_x_m + col * grid.texel_m, first.left, 1e-6);
  const Tile tile = read(world, 0, 0, 0);
  EXPECT_EQ(tile.rgb.at(kTileBorder + col + 5, kTileBorder + row + 9), first.image.at(5, 9));
  const World single = open_images({folder.path() / "a.tif"});
  (void)read(single, 1, 0, 0);
  expect_borders_agree(world, 0);
}

TEST(Tiles, ReadByManyThreadsAreTheSameBytes) {
  TemporaryFolder folder;
  GeoTiff tiff = textured(1600, 1600);
  tiff.jpeg = true;
  testing::write_geotiff(folder.path() / "a.tif", tiff);
  const World world = open_images({folder.path() / "a.tif"});
  std::vector<Tile> expected;
  for (int i = 0; i < 9; ++i) expected.push_back(read(world, i / 5, i % 3, (i / 3) % 3));
  const World again = open_images({folder.path() / "a.tif"});
  std::atomic<int> different{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (int k = 0; k < 9; ++k) {
        const int i = (k * 5 + t) % 9;
        const auto tile = again.tiles->tile({i / 5, i % 3, (i / 3) % 3});
        if (!tile || tile->rgb.data != expected[static_cast<std::size_t>(i)].rgb.data) ++different;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(different, 0);
}

TEST(Tiles, OfALevelOutsideTheLimitAreAnError) {
  TemporaryFolder folder;
  testing::write_geotiff(folder.path() / "a.tif", textured(100, 100));
  const World world = open_images({folder.path() / "a.tif"});
  const auto tile = world.tiles->tile({-1, 0, 0});
  ASSERT_FALSE(tile);
  EXPECT_NE(tile.error().message.find("level = -1"), std::string::npos);
}

}  // namespace
}  // namespace overfly::terrain
