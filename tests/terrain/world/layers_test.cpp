// Layers of any format, coordinate system, unit and datum, laid over each other.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/support/synthetic_world.hpp"
#include "tests/terrain/cache/built_world.hpp"
#include "tests/terrain/layered_world.hpp"
#include "tests/terrain/raster_file.hpp"

namespace overfly::terrain {
namespace {

namespace fs = std::filesystem;
using testing::RasterFile;
using testing::TemporaryFolder;

World over(const std::vector<fs::path>& imagery) {
  WorldSpec spec;
  for (const fs::path& file : imagery) spec.imagery.emplace_back().file = file;
  spec.ground_height_m = 200.0;
  return opened(spec);
}

/// Colours of the valid texels of all tiles of a level, and how many texels have each.
std::map<int, int> colours(const World& world, int level) {
  std::map<int, int> counts;
  const TileGrid& grid = world.tiles->grid();
  for (int row = 0; row <= (grid.rows - 1) >> level; ++row) {
    for (int col = 0; col <= (grid.cols - 1) >> level; ++col) {
      const auto tile = world.tiles->tile({level, col, row});
      if (!tile) throw std::runtime_error(tile.error().message);
      for (int v = kTileBorder; v < kTileBorder + kTileTexels; ++v) {
        for (int u = kTileBorder; u < kTileBorder + kTileTexels; ++u) {
          if (tile->valid.at(u, v) != 0) ++counts[tile->rgb.at(u, v, 1)];
        }
      }
    }
  }
  return counts;
}

TEST(Layers, OfEveryFormatHaveTheSameTexels) {
  TemporaryFolder folder;
  struct Format {
    const char* file;
    const char* driver;
    std::vector<std::string> options;
  };
  const Format formats[] = {{"a.tif", "GTiff", {}},
                            {"cog.tif", "COG", {"COMPRESS=DEFLATE", "OVERVIEWS=NONE"}},
                            {"a.img", "HFA", {}},
                            {"a.jp2", "JP2OpenJPEG", {"REVERSIBLE=YES", "QUALITY=100"}},
                            {"a.vrt", "VRT", {}},
                            {"a.png", "PNG", {}}};
  std::optional<Tile> first;
  for (const Format& format : formats) {
    RasterFile raster;
    raster.bands = 3;
    raster.width_px = raster.height_px = 400;
    raster.driver = format.driver;
    raster.options = format.options;
    const fs::path file = folder.path() / format.file;
    if (std::string(format.driver) == "VRT") {
      testing::write_text(file, R"(<VRTDataset rasterXSize="400" rasterYSize="400">
<SRS>EPSG:32616</SRS><GeoTransform>583000, 2, 0, 4357000, 0, -2</GeoTransform>)");
      std::string text = testing::read_text(file);
      for (const char* band : {"1", "2", "3"}) {
        text += std::string("<VRTRasterBand dataType=\"Byte\" band=\"") + band +
                "\"><SimpleSource><SourceFilename relativeToVRT=\"1\">a.tif</SourceFilename>"
                "<SourceBand>" +
                band + "</SourceBand></SimpleSource></VRTRasterBand>";
      }
      testing::write_text(file, text + "</VRTDataset>");
    } else {
      testing::write_raster(file, raster);
    }
    const World world = over({file});
    EXPECT_DOUBLE_EQ(world.tiles->grid().left_x_m, 583000.0) << file;
    EXPECT_DOUBLE_EQ(world.tiles->grid().top_y_m, 4357000.0) << file;
    auto tile = world.tiles->tile({0, 0, 0});
    ASSERT_TRUE(tile) << tile.error().message;
    if (!first) first = *tile;
    EXPECT_TRUE(tile->rgb.data == first->rgb.data) << file;
  }
}

TEST(Layers, OfHeightsInEveryFormatAreTheSameGround) {
  TemporaryFolder folder;
  RasterFile picture;
  picture.width_px = picture.height_px = 200;
  testing::write_raster(folder.path() / "picture.tif", picture);
  RasterFile heights;
  heights.type = "Int16";
  heights.width_px = heights.height_px = 100;
  heights.transform = {{583000.0 - 200.0, 10.0, 0.0, 4357000.0 + 200.0, 0.0, -10.0}};
  heights.value = [](int x, int y, int) { return 200.0 + (x * x + 3 * y) % 50; };
  for (const auto& [file, driver] : {std::pair("a.tif", "GTiff"),
                                     std::pair("a.img", "HFA"),
                                     std::pair("a.jp2", "JP2OpenJPEG"),
                                     std::pair("cog.tif", "COG")}) {
    heights.driver = driver;
    heights.options.clear();
    if (heights.driver == "JP2OpenJPEG") heights.options = {"REVERSIBLE=YES", "QUALITY=100"};
    testing::write_raster(folder.path() / file, heights);
    WorldSpec spec;
    spec.imagery.emplace_back().file = folder.path() / "picture.tif";
    spec.elevation.emplace_back().file = folder.path() / file;
    spec.elevation.back().datum = VerticalDatum::kEllipsoid;
    const World world = opened(spec);
    for (int i = 0; i < 30; ++i) {
      const int column = 21 + (i * 7) % 37;
      const int row = 22 + (i * 11) % 35;
      const Geodetic at = world.tiles->frame().geodetic_from_world(world.tiles->world_from_map(
          583000.0 - 195.0 + 10.0 * column, 4357000.0 + 195.0 - 10.0 * row));
      EXPECT_NEAR(at.alt_ellipsoid_m, heights.value(column, row, 1), 1e-3) << file;
    }
  }
}

TEST(Layers, ShowTheNextOneThroughAHoleWithoutSmearing) {
  TemporaryFolder folder;
  const auto spec = read_world_manifest(testing::write_layered_world(folder.path(), {200, 50}));
  ASSERT_TRUE(spec) << spec.error().message;
  const World world = opened(*spec);
  constexpr int kHole = testing::kHoleLastPx - testing::kHoleFirstPx;
  for (int level = 0; level < world.tiles->grid().levels; ++level) {
    const auto counts = colours(world, level);
    EXPECT_EQ(counts.size(), 2U) << "level " << level << ": a colour that neither layer has";
    EXPECT_TRUE(counts.contains(200) && counts.contains(50)) << level;
  }
  // The hole is where it was cut, to the texel.
  const TileGrid& grid = world.tiles->grid();
  const auto left = static_cast<int>(std::lround((testing::kLayeredLeftM - grid.left_x_m) / 0.5));
  const auto top = static_cast<int>(std::lround((grid.top_y_m - testing::kLayeredTopM) / 0.5));
  int in_hole = 0;
  for (int y = -2; y < kHole + 2; ++y) {
    for (int x = -2; x < kHole + 2; ++x) {
      const int u = left + testing::kHoleFirstPx + x;
      const int v = top + testing::kHoleFirstPx + y;
      const TileId id{0, u / kTileTexels, v / kTileTexels};
      static std::map<TileId, Tile> read;
      if (!read.contains(id)) read[id] = *world.tiles->tile(id);
      const int value =
          read[id].rgb.at(u % kTileTexels + kTileBorder, v % kTileTexels + kTileBorder, 0);
      const bool inside = x >= 0 && y >= 0 && x < kHole && y < kHole;
      ASSERT_EQ(value, inside ? 50 : 200) << x << ' ' << y;
      in_hole += value == 50;
    }
  }
  EXPECT_EQ(in_hole, kHole * kHole);
}

TEST(Layers, ThatAreResampledDoNotSmearTheirHolesEither) {
  TemporaryFolder folder;
  testing::GeoTiff first;
  first.image = Image(300, 300, 3, 200);
  first.valid = Image(300, 300, 1, 255);
  for (int y = 100; y < 180; ++y) {
    for (int x = 100; x < 180; ++x) {
      first.valid.at(x, y) = 0;
      for (int c = 0; c < 3; ++c) first.image.at(x, y, c) = 0;  // black, as services fill
    }
  }
  first.crs = "EPSG:4326";
  first.left = -86.0352;
  first.top = 39.358;
  first.pixel = 1e-5;
  testing::write_geotiff(folder.path() / "degrees.tif", first);
  testing::GeoTiff second;
  second.image = Image(500, 500, 3, 50);
  second.crs = "EPSG:2966";  // NAD83, Indiana West, US survey feet
  second.left = 3249000.0;
  second.top = 1498700.0;
  second.pixel = 3.0;
  testing::write_geotiff(folder.path() / "feet.tif", second);
  const World world = over({folder.path() / "degrees.tif", folder.path() / "feet.tif"});
  for (int level = 0; level < world.tiles->grid().levels; ++level) {
    const auto counts = colours(world, level);
    EXPECT_TRUE(counts.contains(200) && counts.contains(50)) << level;
    EXPECT_EQ(counts.size(), 2U) << "level " << level << ": a colour that neither layer has";
  }
}

TEST(Layers, MayBeHoledByAValueThatTheManifestSays) {
  TemporaryFolder folder;
  RasterFile first;
  first.width_px = first.height_px = 300;
  first.value = [](int x, int, int) { return x < 100 ? 7.0 : 200.0; };
  testing::write_raster(folder.path() / "first.tif", first);
  RasterFile second = first;
  second.value = [](int, int, int) { return 50.0; };
  second.crs = "EPSG:32617";
  second.transform = {{65900.0, 5.0, 0.0, 4368800.0, 0.0, -5.0}};
  second.width_px = second.height_px = 200;
  testing::write_raster(folder.path() / "second.tif", second);
  WorldSpec spec;
  spec.imagery.emplace_back().file = folder.path() / "first.tif";
  spec.imagery.back().nodata = 7.0;
  spec.imagery.emplace_back().file = folder.path() / "second.tif";
  spec.ground_height_m = 200.0;
  const auto counts = colours(opened(spec), 0);
  EXPECT_FALSE(counts.contains(7));
  EXPECT_EQ(counts.at(200), 200 * 300);
  EXPECT_GT(counts.at(50), 100 * 300);
  EXPECT_EQ(counts.size(), 2U);
}

TEST(Layers, OfHeightsKeepTheirUnitAndDatumEach) {
  TemporaryFolder folder;
  const auto manifest = testing::write_layered_world(folder.path());
  auto spec = read_world_manifest(manifest);
  ASSERT_TRUE(spec) << spec.error().message;
  // Near: feet above the ellipsoid, with a hole. Far: metres above a geoid 33 m below it.
  constexpr double kFootM = 0.3048;
  RasterFile near;
  near.type = "Float32";
  near.width_px = near.height_px = 80;
  near.transform = {{testing::kLayeredLeftM, 4.0, 0.0, testing::kLayeredTopM, 0.0, -4.0}};
  near.unit = "ft";
  near.nodata = -1.0;
  near.value = [](int x, int y, int) {
    return x >= 30 && x < 50 && y >= 30 && y < 50 ? -1.0 : 700.0;
  };
  testing::write_raster(spec->elevation[0].file, near);
  spec->elevation[1].datum = VerticalDatum::kUnknown;
  spec->elevation[1].geoid_separation_m = -33.0;
  const World world = opened(*spec);
  const auto height_at = [&](const World& in, double column, double row) {
    return in.tiles->frame()
        .geodetic_from_world(in.tiles->world_from_map(testing::kLayeredLeftM + 4.0 * column,
                                                      testing::kLayeredTopM - 4.0 * row))
        .alt_ellipsoid_m;
  };
  WorldSpec far_spec = *spec;
  far_spec.elevation.erase(far_spec.elevation.begin());
  const World far = opened(far_spec);
  for (double column = 32.0; column < 48.0; column += 0.7) {
    // The hole's floor is the far layer, right up to its edge.
    EXPECT_NEAR(height_at(world, column, 40.0), height_at(far, column, 40.0), 0.01) << column;
  }
  EXPECT_NEAR(height_at(far, 40.0, 40.0), 205.0 - 33.0, 8.0);
  for (const double column : {5.0, 20.0, 28.0, 52.0, 70.0}) {
    EXPECT_NEAR(height_at(world, column, 40.0), 700.0 * kFootM, 1e-3) << column;
  }
}

TEST(Layers, AreTheSameGroundAtOnePlaceAndAtMany) {
  const TemporaryFolder folder;
  const auto spec = read_world_manifest(testing::write_layered_world(folder.path()));
  ASSERT_TRUE(spec) << spec.error().message;
  const World world = opened(*spec);
  const TileGrid& grid = world.tiles->grid();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> along(-1.0, 1.0);
  // Within the imagery, around it, and with places beyond the range of the projection among them.
  for (const std::vector<double>& reaches_m :
       {std::vector<double>{200.0}, {200.0, 5e3, 90e3}, {200.0, 90e3, 1e9}}) {
    std::vector<Eigen::Vector2d> places_map_m;
    for (int i = 0; i < 300; ++i) {
      const double reach_m = reaches_m[i % reaches_m.size()];
      places_map_m.emplace_back(grid.left_x_m + reach_m * along(random),
                                grid.top_y_m + reach_m * along(random));
    }
    const std::vector<Eigen::Vector3d> points = world.tiles->coarse_world_at(places_map_m, 12.0);
    ASSERT_EQ(points.size(), places_map_m.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d& place = places_map_m[i];
      EXPECT_EQ(points[i], world.tiles->coarse_world_from_map(place.x(), place.y(), 12.0))
          << place.transpose();
    }
  }
}

}  // namespace
}  // namespace overfly::terrain
