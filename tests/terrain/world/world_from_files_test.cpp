#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/world/world_from_files.hpp"
#include "tests/support/support.hpp"
#include "tests/terrain/raster_file.hpp"

namespace overfly::terrain {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::RasterFile;
using testing::TemporaryFolder;

class WorldFromFiles : public ::testing::Test {
 protected:
  fs::path write(const std::string& name, RasterFile raster) {
    testing::write_raster(folder_.path() / name, raster);
    return folder_.path() / name;
  }
  fs::path picture(const std::string& name, double pixel_m, int bands = 3) {
    RasterFile raster;
    raster.bands = bands;
    raster.transform = {{583000.0, pixel_m, 0.0, 4357000.0, 0.0, -pixel_m}};
    return write(name, raster);
  }
  fs::path heights(const std::string& name, double pixel_m, const std::string& type = "Float32") {
    RasterFile raster;
    raster.type = type;
    raster.transform = {{583000.0, pixel_m, 0.0, 4357000.0, 0.0, -pixel_m}};
    return write(name, raster);
  }
  TemporaryFolder folder_;
};

TEST_F(WorldFromFiles, TellsPicturesFromHeightsAndPutsTheFinestFirst) {
  const fs::path coarse_heights = heights("coarse.tif", 30.0, "Int16");
  const fs::path coarse = picture("wide.tif", 10.0);
  const fs::path fine_heights = heights("fine.tif", 2.0);
  const fs::path grey = picture("grey.tif", 5.0, 1);
  const fs::path fine = picture("near.tif", 0.5);
  const auto spec = world_from_files({coarse_heights, coarse, fine_heights, grey, fine});
  ASSERT_TRUE(spec) << spec.error().message;
  ASSERT_EQ(spec->imagery.size(), 3U);
  EXPECT_EQ(spec->imagery[0].file, fine);
  EXPECT_EQ(spec->imagery[1].file, grey);
  EXPECT_EQ(spec->imagery[2].file, coarse);
  ASSERT_EQ(spec->elevation.size(), 2U);
  EXPECT_EQ(spec->elevation[0].file, fine_heights);
  EXPECT_EQ(spec->elevation[1].file, coarse_heights);
}

TEST_F(WorldFromFiles, ComparesSizesOfDegreesAndMetres) {
  RasterFile degrees;
  degrees.crs = "EPSG:4326";
  degrees.transform = {{-86.03, 1e-5, 0.0, 39.36, 0.0, -1e-5}};  // 1.1 m
  const fs::path in_degrees = write("degrees.tif", degrees);
  const fs::path finer = picture("finer.tif", 0.9);
  const fs::path coarser = picture("coarser.tif", 1.4);
  const auto spec = world_from_files({coarser, in_degrees, finer});
  ASSERT_TRUE(spec) << spec.error().message;
  EXPECT_EQ(spec->imagery[0].file, finer);
  EXPECT_EQ(spec->imagery[1].file, in_degrees);
  EXPECT_EQ(spec->imagery[2].file, coarser);
}

TEST_F(WorldFromFiles, KnowsNativeElevationFormats) {
  OVERFLY_DATA_OR_SKIP(hgt, "terrain/elevation_formats/N44W072.hgt");
  OVERFLY_DATA_OR_SKIP(dem, "terrain/elevation_formats/mtsthelens_after_usgs.dem");
  const auto spec = world_from_files({hgt, dem, picture("near.tif", 0.5)});
  ASSERT_TRUE(spec) << spec.error().message;
  EXPECT_EQ(spec->elevation.size(), 2U);
}

TEST_F(WorldFromFiles, DoesNotGuessWhatMayBeBoth) {
  const auto spec =
      world_from_files({picture("near.tif", 0.5), heights("either.tif", 5.0, "UInt16")});
  ASSERT_FALSE(spec);
  EXPECT_EQ(spec.error().code, ErrorCode::kInvalidArgument);
  EXPECT_THAT(spec.error().message, HasSubstr("either.tif: one band of 16-bit numbers"));
}

TEST_F(WorldFromFiles, NeedsAPicture) {
  const auto spec = world_from_files({heights("fine.tif", 2.0)});
  ASSERT_FALSE(spec);
  EXPECT_THAT(spec.error().message, HasSubstr("a world needs imagery"));
  EXPECT_EQ(world_from_files({folder_.path() / "gone.tif"}).error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace overfly::terrain
