// Layers of heights of different size and spacing: what they cover, the grid onto which they are
// laid, and how far it reaches.
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/terrain/cache/built_world.hpp"
#include "tests/terrain/raster_file.hpp"

namespace overfly::terrain {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::RasterFile;
using testing::TemporaryFolder;

/// Middle of the imagery in UTM zone 16 [m].
constexpr double kMiddleX = 583000.0;
constexpr double kMiddleY = 4357000.0;

class MergedElevation : public ::testing::Test {
 protected:
  /// 64 x 64 pixels around the middle.
  void add_picture(double pixel_m) {
    RasterFile raster;
    raster.transform = {
        {kMiddleX - 32.0 * pixel_m, pixel_m, 0.0, kMiddleY + 32.0 * pixel_m, 0.0, -pixel_m}};
    testing::write_raster(folder_.path() / "picture.tif", raster);
    spec_.imagery.emplace_back().file = folder_.path() / "picture.tif";
  }

  /// Adds a square of heights.
  /// @param east_m  of its middle from that of the imagery, as `north_m`
  /// @param height_m  of a post, whose place is given from the imagery's middle
  void add_heights(double side_m,
                   double post_m,
                   double east_m,
                   double north_m,
                   const std::function<double(double east_m, double north_m)>& height_m) {
    RasterFile raster;
    raster.type = "Float32";
    raster.width_px = raster.height_px = static_cast<int>(std::lround(side_m / post_m));
    const double left = east_m - 0.5 * side_m;
    const double top = north_m + 0.5 * side_m;
    raster.transform = {{kMiddleX + left, post_m, 0.0, kMiddleY + top, 0.0, -post_m}};
    raster.nodata = -9999.0;
    raster.value = [=](int x, int y, int) {
      return height_m(left + (x + 0.5) * post_m, top - (y + 0.5) * post_m);
    };
    ElevationLayer& layer = spec_.elevation.emplace_back();
    layer.file = folder_.path() / ("heights" + std::to_string(spec_.elevation.size()) + ".tif");
    layer.datum = VerticalDatum::kEllipsoid;
    testing::write_raster(layer.file, raster);
  }

  static double height_m(const World& world, double east_m, double north_m) {
    const Eigen::Vector3d ground =
        world.tiles->world_from_map(kMiddleX + east_m, kMiddleY + north_m);
    return world.tiles->frame().geodetic_from_world(ground).alt_ellipsoid_m;
  }

  TemporaryFolder folder_;
  WorldSpec spec_;
};

TEST_F(MergedElevation, MayCoverAsLittleOfTheImageryAsItLikes) {
  add_picture(300.0);
  add_heights(200.0, 5.0, 37.0, -20.0, [](double, double) { return 500.0; });
  const World world = opened(spec_);
  // 200 m of 19.2 km, squared.
  EXPECT_THAT(world.warnings, Contains(HasSubstr("covers 0.011 % of the imagery")));
  EXPECT_NEAR(height_m(world, 0.0, 0.0), 500.0, 1e-3);
}

TEST_F(MergedElevation, OutsideOfTheImageryIsAnError) {
  add_picture(300.0);
  add_heights(200.0, 5.0, 9800.0, 0.0, [](double, double) { return 500.0; });
  const auto world = open_world(spec_);
  ASSERT_FALSE(world);
  EXPECT_THAT(world.error().message, HasSubstr("does not overlap the imagery"));
}

TEST_F(MergedElevation, HasTheHeightsOfItsFinestLayerAtThePostsOfThat) {
  add_picture(2.0);
  const auto waves = [](double east_m, double north_m) {
    return 500.0 + 10.0 * std::sin(0.8 * east_m) * std::cos(0.5 * north_m);
  };
  add_heights(120.0, 2.0, 0.7, 0.3, waves);
  add_heights(800.0, 20.0, 0.0, 0.0, [](double, double) { return 450.0; });
  const World world = opened(spec_);
  for (int i = -20; i < 20; ++i) {
    const double east_m = 0.7 + 2.0 * i + 1.0;
    const double north_m = 0.3 - 2.0 * (i % 7) + 1.0;
    EXPECT_NEAR(height_m(world, east_m, north_m), waves(east_m, north_m), 1e-3) << "post " << i;
  }
}

TEST_F(MergedElevation, CountsOnlyVoidsOfItsFilesAsPostsWithoutData) {
  add_picture(2.0);
  add_heights(100.0, 5.0, 0.0, 0.0, [](double, double) { return 500.0; });
  add_heights(900.0, 30.0, 0.0, 0.0, [](double, double) { return 450.0; });
  EXPECT_THAT(opened(spec_).warnings, IsEmpty());
  spec_.elevation.pop_back();
  add_heights(900.0, 30.0, 0.0, 0.0, [](double east_m, double north_m) {
    return std::hypot(east_m - 300.0, north_m) < 25.0 ? -9999.0 : 450.0;
  });
  // Four posts and the meshes around them: 90 m x 90 m of 900 m x 900 m.
  EXPECT_THAT(opened(spec_).warnings,
              ElementsAre(HasSubstr("merged elevation: 324 of 32400 posts (1.0 %)")));
}

TEST_F(MergedElevation, ReachesAsFarAsItsCoarseLayerWhateverTheSpacingOfTheFineOne) {
  add_picture(2.0);
  const auto hill = [](double east_m, double north_m) {
    return 500.0 + 0.1 * std::abs(east_m) + 0.05 * north_m;
  };
  // At 0.6 m between posts, one grid over all would have too many.
  add_heights(99.0, 0.6, 0.0, 0.0, hill);
  add_heights(4200.0, 30.0, 0.0, 0.0, hill);
  const fs::path manifest = folder_.path() / "world.json";
  ASSERT_TRUE(write_world_manifest(manifest, spec_));
  spec_ = spec_of(manifest);
  const World world = opened(spec_);
  EXPECT_THAT(world.warnings, IsEmpty());
  for (const double east_m : {40.0, 150.0, 300.0, 360.0, 600.0, 2050.0}) {
    EXPECT_NEAR(height_m(world, east_m, 10.0), hill(east_m, 10.0), 0.02) << "at " << east_m;
  }
  EXPECT_NEAR(world.tiles->height_range_m().y(), hill(2085.0, 2085.0), 0.5);

  (void)built(spec_);
  const World from_cache = opened(spec_);
  EXPECT_THAT(from_cache.cache, HasSubstr("in use"));
  EXPECT_THAT(from_cache.warnings, IsEmpty());
  EXPECT_EQ(from_cache.tiles->height_range_m(), world.tiles->height_range_m());
  for (double x = kMiddleX - 2200.0; x < kMiddleX + 2200.0; x += 17.0) {
    EXPECT_EQ(from_cache.tiles->world_from_map(x, kMiddleY),
              world.tiles->world_from_map(x, kMiddleY));
    EXPECT_EQ(from_cache.tiles->coarse_world_from_map(x, kMiddleY, 40.0),
              world.tiles->coarse_world_from_map(x, kMiddleY, 40.0));
  }
}

/// Writes posts of 1 m as bytes, in rows that are all equal.
void write_equal_rows(const fs::path& file,
                      std::vector<std::uint8_t> row,
                      std::array<double, 6> transform) {
  GDALAllRegister();
  const int side = static_cast<int>(row.size());
  const GDALDatasetUniquePtr raster(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      file.c_str(), side, side, 1, GDT_Byte, nullptr));
  OGRSpatialReference utm;
  utm.importFromEPSG(32616);
  ASSERT_EQ(raster->SetGeoTransform(transform.data()), CE_None);
  ASSERT_EQ(raster->SetSpatialRef(&utm), CE_None);
  GDALRasterBand& band = *raster->GetRasterBand(1);
  for (int y = 0; y < side; ++y) {
    const CPLErr written =
        band.RasterIO(GF_Write, 0, y, side, 1, row.data(), side, 1, GDT_Byte, 0, 0, nullptr);
    ASSERT_EQ(written, CE_None);
  }
}

/// One file with more posts than are read when a world is opened.
TEST_F(MergedElevation, OfOneLargeFileContinuesBeyondItsFinePostsWithoutAStep) {
  add_picture(8.0);
  constexpr double kHalfM = 3300.0;
  std::vector<std::uint8_t> row(static_cast<std::size_t>(2.0 * kHalfM));
  for (std::size_t x = 0; x < row.size(); ++x) row[x] = static_cast<std::uint8_t>(x / 32);
  write_equal_rows(folder_.path() / "heights.tif",
                   row,
                   {kMiddleX - kHalfM, 1.0, 0.0, kMiddleY + kHalfM, 0.0, -1.0});
  spec_.elevation.emplace_back().file = folder_.path() / "heights.tif";
  spec_.elevation.back().datum = VerticalDatum::kEllipsoid;
  const World world = opened(spec_);
  EXPECT_THAT(describe(world),
              HasSubstr("every 1.00 m to 300 m around the imagery, every 4.00 m beyond"));
  double before_m = height_m(world, 0.0, 100.0);
  for (double east_m = 0.0; east_m < kHalfM; east_m += 3.0) {
    const double now_m = height_m(world, east_m, 100.0);
    // Steps of a metre, each over one mesh.
    EXPECT_NEAR(now_m, (east_m + kHalfM) / 32.0 - 0.5, 0.65) << "at " << east_m;
    EXPECT_LE(std::abs(now_m - before_m), 1.01) << "a step at " << east_m;
    before_m = now_m;
  }
  // Between the used posts at 5790.5 m and 5794.5 m from the western edge, a step lies at 5792 m.
  EXPECT_NEAR(height_m(world, 5792.5 - kHalfM, 100.0), 180.5, 1e-3);
  EXPECT_NEAR(height_m(world, 5793.5 - kHalfM, 100.0), 180.75, 1e-3);
  EXPECT_NEAR(height_m(world, 20e3, 0.0), 206.0, 1e-3) << "beyond, the height of the edge";
  EXPECT_EQ(world.tiles->height_range_m(), Eigen::Vector2d(0.0, 206.0));
}

/// Overviews that are averages mix heights with voids that only the manifest declares.
TEST_F(MergedElevation, OfOneLargeFileTakesNoHeightsFromOverviewsThatMixVoids) {
  add_picture(8.0);
  constexpr double kHalfM = 3300.0;
  constexpr std::uint8_t kVoid = 255;
  std::vector<std::uint8_t> row(static_cast<std::size_t>(2.0 * kHalfM), 100);
  std::fill_n(row.begin() + 6002, 9, kVoid);
  const fs::path file = folder_.path() / "heights.tif";
  write_equal_rows(file, row, {kMiddleX - kHalfM, 1.0, 0.0, kMiddleY + kHalfM, 0.0, -1.0});
  {
    const GDALDatasetUniquePtr raster(GDALDataset::Open(file.c_str(), GDAL_OF_UPDATE));
    const std::array<int, 1> levels = {4};
    const CPLErr made =
        raster->BuildOverviews("AVERAGE", 1, levels.data(), 0, nullptr, nullptr, nullptr);
    ASSERT_EQ(made, CE_None);
  }
  spec_.elevation.emplace_back().file = file;
  spec_.elevation.back().datum = VerticalDatum::kEllipsoid;
  spec_.elevation.back().nodata = kVoid;
  const World world = opened(spec_);
  EXPECT_THAT(world.warnings, Contains(HasSubstr("far from the imagery: 43560000 posts are read")));
  EXPECT_EQ(world.tiles->height_range_m(), Eigen::Vector2d(100.0, 100.0));
  EXPECT_NEAR(height_m(world, 6002.0 - kHalfM, 100.0), 100.0, 1e-6);
}

}  // namespace
}  // namespace overfly::terrain
