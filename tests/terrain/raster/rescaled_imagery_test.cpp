// Samples that are not 8 bit: one range of values for all bands and for all files of a mosaic.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/terrain/cache/built_world.hpp"
#include "tests/terrain/raster_file.hpp"

namespace overfly::terrain {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::RasterFile;
using testing::TemporaryFolder;

class RescaledImagery : public ::testing::Test {
 protected:
  /// Adds a file of 64 x 64 pixels of 2 m to the east of the one before.
  void add(const std::function<double(int x, int y, int band)>& value,
           const std::string& type = "UInt16",
           int bands = 1,
           const std::vector<std::string>& options = {}) {
    RasterFile raster;
    raster.type = type;
    raster.bands = bands;
    raster.options = options;
    raster.value = value;
    (*raster.transform)[0] += 128.0 * static_cast<double>(spec_.imagery.size());
    const fs::path file = folder_.path() / ("part" + std::to_string(spec_.imagery.size()) + ".tif");
    testing::write_raster(file, raster);
    spec_.imagery.emplace_back().file = file;
    spec_.ground_height_m = 200.0;
  }

  /// Colour of a pixel, counted from the first file's north-west corner.
  static std::array<int, 3> colour(const World& world, int x, int y) {
    const auto tile = world.tiles->tile({0, 0, 0});
    if (!tile) throw std::runtime_error(tile.error().message);
    const int u = kTileBorder + x;
    const int v = kTileBorder + y;
    return {tile->rgb.at(u, v, 0), tile->rgb.at(u, v, 1), tile->rgb.at(u, v, 2)};
  }

  TemporaryFolder folder_;
  WorldSpec spec_;
};

TEST_F(RescaledImagery, HasNoStepBetweenTheFilesOfAMosaic) {
  add([](int x, int, int) { return 1000.0 + 10.0 * x; });
  add([](int x, int, int) { return 1640.0 + 10.0 * x; });
  const World world = opened(spec_);
  EXPECT_THAT(world.warnings, ElementsAre(HasSubstr("part0.tif"), HasSubstr("part1.tif")));
  for (int x = 58; x < 70; ++x) {
    EXPECT_NEAR(colour(world, x, 30)[0], 255.0 * x / 127.0, 3.0) << "pixel " << x;
  }
}

TEST_F(RescaledImagery, KeepsTheRatioOfItsBands) {
  constexpr std::array<double, 3> kFactors{4.0, 2.0, 3.0};
  const auto value = [&](int x, int, int band) { return (100.0 + 5.0 * x) * kFactors[band - 1]; };
  add(value, "Int16", 3);
  const World world = opened(spec_);
  // From 200, the darkest green, to 1660, the lightest red.
  for (const int x : {10, 30, 55}) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(colour(world, x, 20)[c], 255.0 * (value(x, 20, c + 1) - 200.0) / 1460.0, 5.0)
          << "pixel " << x << ", band " << c + 1;
    }
  }
}

TEST_F(RescaledImagery, OfAnotherTypeHasARangeOfItsOwn) {
  add([](int x, int, int) { return 1000.0 + x; });
  add([](int x, int, int) { return 0.01 * x; }, "Float32");
  const World world = opened(spec_);
  EXPECT_NEAR(colour(world, 32, 30)[0], 129, 4);
  EXPECT_NEAR(colour(world, 64 + 32, 30)[0], 129, 4);
}

TEST_F(RescaledImagery, TakesTheRangeOfTheManifestEvenFromACache) {
  for (int i = 0; i < 2; ++i) {
    add([](int x, int, int) { return 1000.0 + x; });
    spec_.imagery.back().range = {{1000.0, 1255.0}};
  }
  const fs::path manifest = folder_.path() / "world.json";
  ASSERT_TRUE(write_world_manifest(manifest, spec_));
  spec_ = spec_of(manifest);
  (void)built(spec_);
  const World world = opened(spec_);
  EXPECT_THAT(world.cache, HasSubstr("in use"));
  EXPECT_THAT(world.warnings, IsEmpty());
  for (const int x : {0, 20, 63, 64 + 40}) {
    EXPECT_EQ(colour(world, x, 30)[2], x % 64) << "pixel " << x;
  }
  spec_.imagery[1].range = {{1000.0, 1510.0}};
  const World changed = opened(spec_);
  EXPECT_THAT(changed.cache, HasSubstr("the manifest has changed"));
  EXPECT_EQ(colour(changed, 64 + 40, 30)[2], 20);
}

/// Of an orthomosaic the collar around the ground is transparent, whatever its values are.
TEST_F(RescaledImagery, ChoosesItsRangeWithoutTransparentPixels) {
  add(
      [](int x, int, int band) {
        if (x >= 32) return band == 4 ? 0.0 : 65535.0;
        return band == 4 ? 65535.0 : 1000.0 + 10.0 * x;
      },
      "UInt16",
      4,
      {"PHOTOMETRIC=RGB", "ALPHA=YES"});
  const World world = opened(spec_);
  EXPECT_NEAR(colour(world, 16, 30)[0], 255.0 * 160.0 / 310.0, 3.0);
}

TEST_F(RescaledImagery, WithoutNumbersIsVoid) {
  add([](int x, int, int) { return x < 32 ? 0.01 * x : std::numeric_limits<double>::quiet_NaN(); },
      "Float32");
  const World world = opened(spec_);
  const TileGrid& grid = world.tiles->grid();
  EXPECT_TRUE(world.tiles->has_imagery(grid.left_x_m + 20.0, grid.top_y_m - 60.0));
  EXPECT_FALSE(world.tiles->has_imagery(grid.left_x_m + 100.0, grid.top_y_m - 60.0));
  EXPECT_NEAR(colour(world, 16, 30)[0], 255.0 * 16.0 / 31.0, 3.0);
}

TEST_F(RescaledImagery, OfEightBitsTakesNoRange) {
  add([](int x, int, int) { return x; }, "Byte");
  spec_.imagery[0].range = {{0.0, 50.0}};
  const auto world = open_world(spec_);
  ASSERT_FALSE(world);
  EXPECT_THAT(world.error().message, HasSubstr("part0.tif: samples are 8 bit"));
}

}  // namespace
}  // namespace overfly::terrain
