// What files say of themselves reaches the user: vertical datums, blocks that were never written,
// GDAL's own warnings.
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "terrain/place/geoid.hpp"
#include "terrain/raster/gdal_dataset.hpp"
#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/terrain/raster_file.hpp"

namespace overfly::terrain {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::RasterFile;
using testing::TemporaryFolder;

class WhatFilesSay : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }

  /// A picture over Indiana with heights of 250 m in a CRS, whose file says what they count from.
  World world_over(const std::string& crs, const std::array<double, 6>& transform) {
    RasterFile picture;
    testing::write_raster(path("picture.tif"), picture);
    RasterFile heights;
    heights.type = "Float32";
    heights.crs = crs;
    heights.transform = transform;
    heights.value = [](int, int, int) { return 250.0; };
    testing::write_raster(path("heights.tif"), heights);
    WorldSpec spec;
    spec.imagery.emplace_back().file = path("picture.tif");
    spec.elevation.emplace_back().file = path("heights.tif");
    auto world = open_world(spec);
    EXPECT_TRUE(world) << (world ? "" : world.error().message);
    return world ? *world : World{};
  }

  TemporaryFolder folder_;
};

/// Around the picture, in UTM zone 16 and in degrees.
constexpr std::array<double, 6> kUtm{582500.0, 20.0, 0.0, 4357500.0, 0.0, -20.0};
constexpr std::array<double, 6> kDegrees{-86.05, 0.001, 0.0, 39.37, 0.0, -0.001};

std::string elevation_line(const World& world) {
  const std::string text = describe(world);
  const std::size_t at = text.find("elevation: ");
  return text.substr(at, text.find('\n', at) - at);
}

TEST_F(WhatFilesSay, AVerticalCrsThatIsKnownIsNamedAsTheDatum) {
  const World world = world_over("EPSG:32616+5773", kUtm);  // EGM96 height
  EXPECT_THAT(elevation_line(world),
              HasSubstr("vertical datum egm96 (the file's: EGM96 height), to the ellipsoid by "));
  EXPECT_THAT(world.warnings, Not(Contains(HasSubstr("vertical datum"))));
  // The geoid lies 33 m below the ellipsoid in Indiana.
  EXPECT_NEAR(world.tiles->height_range_m().x(), 250.0 - 33.5, 1.0);
}

TEST_F(WhatFilesSay, AVerticalCrsThatIsNotKnownIsNamedInTheWarning) {
  const World world = world_over("EPSG:32616+5711", kUtm);  // AHD height
  EXPECT_THAT(elevation_line(world), HasSubstr("vertical datum unknown (the file's: AHD height)"));
  EXPECT_THAT(world.warnings, Contains(HasSubstr("vertical datum \"AHD height\" is unknown")));
}

TEST_F(WhatFilesSay, HeightsOfAThreeDimensionalCrsAreEllipsoidal) {
  const World world = world_over("EPSG:4979", kDegrees);
  EXPECT_THAT(elevation_line(world), HasSubstr("vertical datum ellipsoid (the file's: "));
  EXPECT_THAT(world.warnings, Not(Contains(HasSubstr("vertical datum"))));
  EXPECT_EQ(world.tiles->height_range_m(), Eigen::Vector2d(250.0, 250.0));
}

/// PROJ opens the grid of an older name in place of the one that it is asked for.
TEST_F(WhatFilesSay, TheGridIsNamedAsItLiesOnTheMachine) {
  std::vector<std::string> warnings;
  const auto model = choose_geoid(VerticalDatum::kEgm96, {}, 0.69, -1.5, "file", warnings);
  ASSERT_TRUE(model);
  if (model->built_in) GTEST_SKIP() << "no EGM96 grid is installed";
  bool found = false;
  for (const char* folder : {"/usr/share/proj", "/usr/local/share/proj"}) {
    found = found || fs::exists(fs::path(folder) / model->grid);
  }
  if (!found && std::getenv("PROJ_LIB") != nullptr) GTEST_SKIP() << "grids lie in PROJ_LIB";
  EXPECT_TRUE(found) << model->grid;
}

/// A TIFF of 256 x 256 texels in blocks of 64, of which only the left half is written.
void write_half(const fs::path& file) {
  GDALAllRegister();
  const char* const options[] = {
      "TILED=YES", "BLOCKXSIZE=64", "BLOCKYSIZE=64", "SPARSE_OK=TRUE", nullptr};
  const DatasetPtr dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      file.c_str(), 256, 256, 3, GDT_Byte, const_cast<char**>(options)));
  ASSERT_TRUE(dataset);
  double transform[] = {583000.0, 2.0, 0.0, 4357000.0, 0.0, -2.0};
  ASSERT_EQ(dataset->SetGeoTransform(transform), CE_None);
  OGRSpatialReference crs;
  crs.importFromEPSG(32616);
  ASSERT_EQ(dataset->SetSpatialRef(&crs), CE_None);
  std::vector<std::uint8_t> grey(3 * 128 * 256, 90);
  ASSERT_EQ(
      dataset->RasterIO(
          GF_Write, 0, 0, 128, 256, grey.data(), 128, 256, GDT_Byte, 3, nullptr, 0, 0, 0, nullptr),
      CE_None);
}

TEST_F(WhatFilesSay, BlocksThatWereNeverWrittenAreNoImagery) {
  write_half(path("half.tif"));
  WorldSpec spec;
  spec.imagery.emplace_back().file = path("half.tif");
  spec.ground_height_m = 250.0;
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  EXPECT_THAT(describe(*world), AllOf(HasSubstr("imagery gaps: 50 %"), HasSubstr("masked: 50 %")));
  const TileGrid& grid = world->tiles->grid();
  EXPECT_TRUE(world->tiles->has_imagery(grid.left_x_m + 100.0, grid.top_y_m - 100.0));
  EXPECT_FALSE(world->tiles->has_imagery(grid.left_x_m + 400.0, grid.top_y_m - 100.0));
  for (int level = 0; level < grid.levels; ++level) {
    const auto tile = world->tiles->tile({level, 0, 0});
    ASSERT_TRUE(tile) << tile.error().message;
    const int last = (128 >> level) - 1 + kTileBorder;
    EXPECT_EQ(tile->valid.at(last, 40 >> level), 255) << level;
    EXPECT_EQ(tile->rgb.at(last, 40 >> level, 0), 90) << level;
    EXPECT_EQ(tile->valid.at(last + 1, 40 >> level), 0) << level;
  }
}

/// GDAL shows a compressed strip of more than 2000 rows as single rows, without a table of blocks.
TEST_F(WhatFilesSay, OneLongCompressedStripIsImagery) {
  RasterFile strip;
  strip.height_px = 2001;
  strip.bands = 3;
  strip.options = {"COMPRESS=DEFLATE", "BLOCKYSIZE=2001"};
  testing::write_raster(path("strip.tif"), strip);
  WorldSpec spec;
  spec.imagery.emplace_back().file = path("strip.tif");
  spec.ground_height_m = 250.0;
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  const TileGrid& grid = world->tiles->grid();
  for (const double below_m : {1.0, 100.0, 3900.0}) {
    EXPECT_TRUE(world->tiles->has_imagery(grid.left_x_m + 60.0, grid.top_y_m - below_m)) << below_m;
  }
}

/// Bands of a multispectral camera: GDAL relates transparency to the colours only of files with two
/// or four bands.
TEST_F(WhatFilesSay, TransparencyNextToMoreThanThreeBandsIsNoImagery) {
  RasterFile picture;
  picture.bands = 5;
  picture.alpha_band = 5;
  picture.value = [](int x, int, int band) { return band == 5 ? (x < 32 ? 255.0 : 0.0) : 90.0; };
  testing::write_raster(path("five.tif"), picture);
  WorldSpec spec;
  spec.imagery.emplace_back().file = path("five.tif");
  spec.ground_height_m = 250.0;
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  const TileGrid& grid = world->tiles->grid();
  EXPECT_TRUE(world->tiles->has_imagery(grid.left_x_m + 20.0, grid.top_y_m - 60.0));
  EXPECT_FALSE(world->tiles->has_imagery(grid.left_x_m + 100.0, grid.top_y_m - 60.0));
}

TEST_F(WhatFilesSay, APixelKeepsItsSizeInAFileThatIsTurned) {
  RasterFile picture;
  const double side_m = std::sqrt(2.0);  // 2 m by 2 m, turned by 45 degrees
  picture.transform = {{583000.0, side_m, side_m, 4357000.0, side_m, -side_m}};
  testing::write_raster(path("turned.tif"), picture);
  WorldSpec spec;
  spec.imagery.emplace_back().file = path("turned.tif");
  spec.ground_height_m = 250.0;
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  EXPECT_THAT(describe(*world),
              AnyOf(HasSubstr("px of 2 m"), HasSubstr("px of 2.00"), HasSubstr("px of 1.99")));
}

TEST_F(WhatFilesSay, ASecondLayerFillsWhatTheFirstNeverWrote) {
  write_half(path("half.tif"));
  RasterFile whole;
  whole.width_px = 256;
  whole.height_px = 256;
  whole.value = [](int, int, int) { return 200.0; };
  testing::write_raster(path("whole.tif"), whole);
  WorldSpec spec;
  spec.imagery.emplace_back().file = path("half.tif");
  spec.imagery.emplace_back().file = path("whole.tif");
  spec.ground_height_m = 250.0;
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  const auto tile = world->tiles->tile({0, 0, 0});
  ASSERT_TRUE(tile);
  EXPECT_EQ(tile->rgb.at(100, 100, 0), 90);
  EXPECT_EQ(tile->rgb.at(200, 100, 0), 200);
}

/// Exchanges the last two tags of a TIFF: readers go on from that with a warning.
void exchange_tags(const fs::path& file) {
  std::string bytes = testing::read_text(file);
  const auto number_at = [&](std::size_t at, int count) {
    std::size_t value = 0;
    for (int i = count - 1; i >= 0; --i) {
      value = value << 8U | static_cast<unsigned char>(bytes.at(at + static_cast<std::size_t>(i)));
    }
    return value;
  };
  ASSERT_EQ(bytes.substr(0, 2), "II");
  constexpr std::size_t kTag = 12;
  const std::size_t table = number_at(4, 4);
  const std::size_t last = table + 2 + (number_at(table, 2) - 1) * kTag;
  const std::string tags = bytes.substr(last - kTag, 2 * kTag);
  bytes.replace(last - kTag, 2 * kTag, tags.substr(kTag) + tags.substr(0, kTag));
  testing::write_text(file, bytes);
}

TEST_F(WhatFilesSay, WhatGdalSaysWhileOpeningIsAWarning) {
  const World good = world_over("EPSG:32616", kUtm);
  EXPECT_THAT(good.warnings, Not(Contains(HasSubstr("GDAL reported"))));
  exchange_tags(path("picture.tif"));
  exchange_tags(path("heights.tif"));
  WorldSpec spec = good.spec;
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  for (const char* file : {"picture.tif", "heights.tif"}) {
    EXPECT_THAT(world->warnings,
                Contains(AllOf(HasSubstr(path(file).string() + ": GDAL reported on opening it: "),
                               Not(HasSubstr("no reason given")))));
  }
}

TEST(GdalMessages, TheInnerOnePassesOnToTheOuterWhenAsked) {
  const GdalMessages outer;
  {
    const GdalMessages inner;
    CPLError(CE_Warning, CPLE_AppDefined, "for the inner");
    EXPECT_EQ(inner.text(), "for the inner");
  }
  EXPECT_TRUE(outer.empty());
  {
    const GdalMessages inner;
    CPLError(CE_Warning, CPLE_AppDefined, "for both");
    inner.pass_on();
  }
  EXPECT_EQ(outer.text(), "for both");
}

}  // namespace
}  // namespace overfly::terrain
