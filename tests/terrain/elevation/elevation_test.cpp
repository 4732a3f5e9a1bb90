#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/motion/pose.hpp"
#include "terrain/place/geoid.hpp"
#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/support/synthetic_world.hpp"
#include "tests/terrain/elevation/independent_elevation.hpp"
#include "tests/terrain/raster_file.hpp"

namespace overfly::terrain {
namespace {

using overfly::testing::larger_error;
using testing::IndependentElevation;
using testing::TemporaryFolder;

ElevationLayer elevation_layer(const std::filesystem::path& file, VerticalDatum datum) {
  ElevationLayer layer;
  layer.file = file;
  layer.datum = datum;
  return layer;
}

/// Textured imagery of 400 x 400 m around a place given in a CRS.
ImageryLayer write_imagery_at(const std::filesystem::path& file,
                              const std::string& crs,
                              double x,
                              double y) {
  testing::GeoTiff tiff;
  tiff.image = testing::textured_image(200, 200, 1);
  tiff.crs = crs;
  tiff.left = x - 200.0;
  tiff.top = y + 200.0;
  tiff.pixel = 2.0;
  testing::write_geotiff(file, tiff);
  return {file, "", {}};
}

/// Largest difference between the ground and the file's own heights along vertical world lines.
/// @param half_m  tested square around the world's origin
double largest_difference_m(const World& world,
                            const IndependentElevation& file,
                            double unit_m,
                            double separation_m,
                            double half_m,
                            int& compared) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-half_m, half_m);
  double largest = 0.0;
  compared = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector2d at(place(random), place(random));
    const double up_m = world.tiles->ground_up_m(at.x(), at.y());
    const Geodetic ground = world.tiles->frame().geodetic_from_world({at.x(), at.y(), up_m});
    const double value = file.value_at(ground.lat_rad, ground.lon_rad);
    if (std::isnan(value)) continue;
    ++compared;
    largest =
        larger_error(largest, std::abs(ground.alt_ellipsoid_m - value * unit_m - separation_m));
  }
  return largest;
}

double egm96_m(const Geodetic& at) {
  std::vector<std::string> warnings;
  const auto model =
      choose_geoid(VerticalDatum::kEgm96, {}, at.lat_rad, at.lon_rad, "test", warnings);
  Eigen::Matrix2Xd point(2, 1);
  point << at.lon_rad, at.lat_rad;
  return geoid_separation_m(*model, point)[0];
}

TEST(Elevation, OfAutzenEqualsTheFilesOwnPostsAboveTheGeoid) {
  OVERFLY_DATA_OR_SKIP(photo, "terrain/autzen/ortho_0.3m_utm10.tif");
  OVERFLY_DATA_OR_SKIP(posts, "terrain/autzen/dtm_3m_utm10.tif");
  WorldSpec spec;
  spec.imagery.push_back({photo, "", {}});
  spec.elevation.push_back(elevation_layer(posts, VerticalDatum::kEgm96));
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  int compared = 0;
  // The geoid differs by 3 cm over the kilometre between the middle and the corners.
  const double difference_m = largest_difference_m(*world,
                                                   IndependentElevation(posts, "EPSG:26910"),
                                                   1.0,
                                                   egm96_m(world->tiles->frame().origin()),
                                                   400.0,
                                                   compared);
  EXPECT_GT(compared, 300);
  EXPECT_LT(difference_m, 0.03);
}

TEST(Elevation, WithAConstantSeparationIsExactToAMillimetre) {
  OVERFLY_DATA_OR_SKIP(photo, "terrain/autzen/ortho_0.3m_utm10.tif");
  OVERFLY_DATA_OR_SKIP(posts, "terrain/autzen/dtm_3m_utm10.tif");
  WorldSpec spec;
  spec.imagery.push_back({photo, "", {}});
  spec.elevation.push_back(elevation_layer(posts, VerticalDatum::kUnknown));
  spec.elevation.back().geoid_separation_m = -21.5;
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  int compared = 0;
  EXPECT_LT(largest_difference_m(
                *world, IndependentElevation(posts, "EPSG:26910"), 1.0, -21.5, 450.0, compared),
            1e-3);
  EXPECT_GT(compared, 300);
}

TEST(Elevation, InDegreesEqualsTheFilesOwnPosts) {
  OVERFLY_DATA_OR_SKIP(photo, "terrain/goleta/ortho_epsg4326.tif");
  OVERFLY_DATA_OR_SKIP(posts, "terrain/goleta/elevation_epsg4326.tif");
  WorldSpec spec;
  spec.imagery.push_back({photo, "", {}});
  spec.elevation.push_back(elevation_layer(posts, VerticalDatum::kEllipsoid));
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  int compared = 0;
  EXPECT_LT(largest_difference_m(
                *world, IndependentElevation(posts, "EPSG:4326"), 1.0, 0.0, 650.0, compared),
            1e-3);
  EXPECT_GT(compared, 450);
}

TEST(Elevation, OfAnHgtTileEqualsItsPosts) {
  OVERFLY_DATA_OR_SKIP(posts, "terrain/elevation_formats/N44W072.hgt");
  TemporaryFolder folder;
  WorldSpec spec;
  // 44.5 N, 71.5 W in UTM zone 19.
  spec.imagery.push_back(
      write_imagery_at(folder.path() / "image.tif", "EPSG:32619", 301290.0, 4930250.0));
  spec.elevation.push_back(elevation_layer(posts, VerticalDatum::kEllipsoid));
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  int compared = 0;
  // Far beyond the imagery too: the ground goes on over the whole tile's neighbourhood.
  EXPECT_LT(largest_difference_m(
                *world, IndependentElevation(posts, "EPSG:4326"), 1.0, 0.0, 20000.0, compared),
            2e-3);
  EXPECT_GT(compared, 450);
}

TEST(Elevation, OfAUsgsDemInFeetIsInMetres) {
  OVERFLY_DATA_OR_SKIP(posts, "terrain/elevation_formats/mtsthelens_after_usgs.dem");
  TemporaryFolder folder;
  WorldSpec spec;
  spec.imagery.push_back(
      write_imagery_at(folder.path() / "image.tif", "EPSG:26910", 562710.0, 5114985.0));
  spec.elevation.push_back(elevation_layer(posts, VerticalDatum::kEllipsoid));
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  int compared = 0;
  constexpr double kFootM = 0.3048;
  EXPECT_LT(largest_difference_m(
                *world, IndependentElevation(posts, "EPSG:26710"), kFootM, 0.0, 3000.0, compared),
            2e-3);
  EXPECT_GT(compared, 450);
  // NAD27 without its grid is not exact, and the world says so.
  EXPECT_TRUE(std::any_of(world->warnings.begin(), world->warnings.end(), [](const auto& warning) {
    return warning.find("WGS84") != std::string::npos;
  }));
  // The crater's rim is near 2500 m, which in feet would be 8300.
  EXPECT_LT(world->tiles->height_range_m().y(), 2600.0);
  EXPECT_GT(world->tiles->height_range_m().y(), 2300.0);
}

TEST(Elevation, FollowsTheEarthsCurvature) {
  TemporaryFolder folder;
  testing::SyntheticWorldOptions options;
  options.relief_m = 0.0;
  const auto world = open_world(testing::write_synthetic_world(folder.path(), options));
  ASSERT_TRUE(world) << world.error().message;
  EXPECT_NEAR(world->tiles->ground_up_m(0.0, 0.0), 0.0, 1e-4);
  // d^2 / 2 R = 7.84 m at 10 km, a little more north-south than east-west.
  for (const Eigen::Vector2d& at : {Eigen::Vector2d(10000, 0), Eigen::Vector2d(0, -10000)}) {
    const double up_m = world->tiles->ground_up_m(at.x(), at.y());
    EXPECT_NEAR(up_m, -7.84, 0.03);
    const Geodetic ground = world->tiles->frame().geodetic_from_world({at.x(), at.y(), up_m});
    EXPECT_NEAR(ground.alt_ellipsoid_m, options.ground_m, 1e-3);
  }
}

TEST(Elevation, BeyondItsEdgeGoesOnWithTheEdgesHeight) {
  TemporaryFolder folder;
  testing::SyntheticWorldOptions options;
  WorldSpec spec = testing::write_synthetic_world(folder.path(), options);
  ImageBuffer<float> slope(3, 2, 1);
  for (int x = 0; x < 3; ++x) slope.at(x, 0) = slope.at(x, 1) = 100.0F + 10.0F * x;
  const auto first = open_world(spec);
  ASSERT_TRUE(first) << first.error().message;
  const TileGrid& grid = first->tiles->grid();
  testing::write_elevation(folder.path() / "elevation.tif",
                           slope,
                           "EPSG:32616",
                           grid.left_x_m + 200.0,
                           grid.top_y_m - 200.0,
                           100.0);
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  const TileSource& tiles = *world->tiles;
  const auto height_at = [&](double x, double y) {
    return tiles.frame().geodetic_from_world(tiles.world_from_map(x, y)).alt_ellipsoid_m;
  };
  const double y = grid.top_y_m - 280.0;
  EXPECT_NEAR(height_at(grid.left_x_m + 250.0, y), 100.0, 1e-3) << "the first post's middle";
  EXPECT_NEAR(height_at(grid.left_x_m + 300.0, y), 105.0, 1e-3) << "half way between two posts";
  EXPECT_NEAR(height_at(grid.left_x_m + 10.0, y), 100.0, 1e-3);
  EXPECT_NEAR(height_at(grid.left_x_m + 590.0, y), 120.0, 1e-3);
  EXPECT_NEAR(height_at(grid.left_x_m + 5000.0, y + 4000.0), 120.0, 1e-3);
  ASSERT_EQ(world->warnings.size(), 1U);
  EXPECT_NE(world->warnings[0].find("covers"), std::string::npos) << world->warnings[0];
}

TEST(Elevation, FillsPostsWithoutDataAndSaysHowMany) {
  TemporaryFolder folder;
  WorldSpec spec = testing::write_synthetic_world(folder.path());
  const auto whole = open_world(spec);
  ASSERT_TRUE(whole);
  const TileGrid& grid = whole->tiles->grid();
  ImageBuffer<float> posts(100, 100, 1, 50.0F);
  for (int i = 40; i < 45; ++i) posts.at(i, 50) = std::nanf("");
  testing::write_elevation(folder.path() / "elevation.tif",
                           posts,
                           "EPSG:32616",
                           grid.left_x_m - 200.0,
                           grid.top_y_m + 200.0,
                           10.0);
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  EXPECT_DOUBLE_EQ(world->tiles->height_range_m().x(), 50.0);
  EXPECT_DOUBLE_EQ(world->tiles->height_range_m().y(), 50.0);
  ASSERT_EQ(world->warnings.size(), 1U);
  EXPECT_NE(world->warnings[0].find("5 of 10000 posts"), std::string::npos) << world->warnings[0];
}

TEST(Elevation, WithAVoidInTheManifestIgnoresTheFilesMask) {
  TemporaryFolder folder;
  const auto file = folder.path() / "masked.tif";
  testing::RasterFile posts;
  posts.type = "Float32";
  posts.transform = {{582000.0, 50.0, 0.0, 4358000.0, 0.0, -50.0}};
  posts.value = [](int x, int, int) { return x == 20 ? -1.0 : 120.0; };
  testing::write_raster(file, posts);
  {
    const GDALDatasetUniquePtr dataset(
        GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
    ASSERT_EQ(dataset->CreateMaskBand(GMF_PER_DATASET), CE_None);
    ASSERT_EQ(dataset->GetRasterBand(1)->GetMaskBand()->Fill(0.0), CE_None);
  }
  WorldSpec spec;
  spec.imagery.push_back(
      write_imagery_at(folder.path() / "picture.tif", "EPSG:32616", 583000.0, 4357000.0));
  spec.elevation.push_back(elevation_layer(file, VerticalDatum::kEllipsoid));
  EXPECT_FALSE(open_world(spec).ok()) << "no post has data by the mask";
  spec.elevation.back().nodata = -1.0;
  const auto world = open_world(spec);
  ASSERT_TRUE(world.ok()) << world.error().message;
  EXPECT_EQ(world->tiles->height_range_m(), Eigen::Vector2d(120.0, 120.0));
}

TEST(Elevation, OfTheWholeEarthMayBeginAnywhereAndHavePostsAtThePoles) {
  TemporaryFolder folder;
  WorldSpec spec;
  spec.imagery.push_back(
      write_imagery_at(folder.path() / "picture.tif", "EPSG:32616", 583000.0, 4357000.0));
  const auto file = folder.path() / "earth.tif";
  spec.elevation.push_back(elevation_layer(file, VerticalDatum::kEllipsoid));
  testing::RasterFile posts;
  posts.type = "Float32";
  posts.crs = "EPSG:4326";
  posts.height_px = 361;
  // The last one repeats its first column.
  for (const auto& [first_deg, columns] : {std::pair(-180.0, 720), {0.0, 720}, {180.0, 721}}) {
    posts.width_px = columns;
    posts.transform = {{first_deg - 0.25, 0.5, 0.0, 90.25, 0.0, -0.5}};
    // Rises to the east by 10 m a degree from 90 deg W.
    posts.value = [first_deg = first_deg](int x, int, int) {
      return 10.0 * (std::remainder(first_deg + 0.5 * x, 360.0) + 90.0);
    };
    testing::write_raster(file, posts);
    const auto world = open_world(spec);
    ASSERT_TRUE(world.ok()) << world.error().message;
    const Geodetic& origin = world->tiles->frame().origin();
    EXPECT_NEAR(origin.alt_ellipsoid_m, 10.0 * (deg_from_rad(origin.lon_rad) + 90.0), 0.05)
        << first_deg;
  }
}

TEST(Elevation, OfSeveralLayersTakesTheFirstThatHasDataWithoutAGap) {
  TemporaryFolder folder;
  WorldSpec spec = testing::write_synthetic_world(folder.path());
  const auto whole = open_world(spec);
  ASSERT_TRUE(whole);
  const TileGrid& grid = whole->tiles->grid();
  ImageBuffer<float> low(140, 140, 1, 100.0F);
  ImageBuffer<float> high(20, 20, 1, 130.0F);
  testing::write_elevation(folder.path() / "elevation.tif",
                           low,
                           "EPSG:32616",
                           grid.left_x_m - 400.0,
                           grid.top_y_m + 400.0,
                           10.0);
  testing::write_elevation(folder.path() / "hill.tif",
                           high,
                           "EPSG:32616",
                           grid.left_x_m + 200.0,
                           grid.top_y_m - 200.0,
                           10.0);
  spec.elevation.insert(spec.elevation.begin(),
                        elevation_layer(folder.path() / "hill.tif", VerticalDatum::kEllipsoid));
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  const TileSource& tiles = *world->tiles;
  const auto height_at = [&](double x) {
    const Eigen::Vector3d p = tiles.world_from_map(grid.left_x_m + x, grid.top_y_m - 300.0);
    return tiles.frame().geodetic_from_world(p).alt_ellipsoid_m;
  };
  EXPECT_NEAR(height_at(300.0), 130.0, 1e-3);
  EXPECT_NEAR(height_at(100.0), 100.0, 1e-3);
  for (double x = 150.0; x < 250.0; x += 0.5) {
    EXPECT_LT(std::abs(height_at(x + 0.5) - height_at(x)), 2.0) << "a step at " << x;
  }
}

TEST(Elevation, OnTheVerticalWorldLineIsTheMapsOwnPoint) {
  TemporaryFolder folder;
  testing::SyntheticWorldOptions options;
  options.relief_m = 120.0;
  const auto world = open_world(testing::write_synthetic_world(folder.path(), options));
  ASSERT_TRUE(world) << world.error().message;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-5000.0, 5000.0);
  for (int i = 0; i < 300; ++i) {
    const double east_m = place(random);
    const double north_m = place(random);
    const Eigen::Vector2d map = world->tiles->map_from_world(east_m, north_m);
    const Eigen::Vector3d back = world->tiles->world_from_map(map.x(), map.y());
    EXPECT_NEAR(back.x(), east_m, 1e-5);
    EXPECT_NEAR(back.y(), north_m, 1e-5);
    EXPECT_NEAR(back.z(), world->tiles->ground_up_m(east_m, north_m), 1e-5);
  }
}

}  // namespace
}  // namespace overfly::terrain
