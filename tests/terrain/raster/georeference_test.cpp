// Files without a place on the earth: what their errors advise, and what the manifest may replace.
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/terrain/raster_file.hpp"

namespace overfly::terrain {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::RasterFile;
using testing::TemporaryFolder;

WorldSpec spec_over(const std::filesystem::path& picture) {
  WorldSpec spec;
  spec.imagery.emplace_back().file = picture;
  spec.ground_height_m = 200.0;
  return spec;
}

TEST(Georeference, OfGroundControlPointsOnlyIsAnErrorThatNamesTheRemedy) {
  TemporaryFolder folder;
  const auto file = folder.path() / "points.tif";
  RasterFile picture;
  picture.crs.clear();
  picture.transform.reset();
  testing::write_raster(file, picture);
  {
    const GDALDatasetUniquePtr dataset(
        GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
    std::array<GDAL_GCP, 4> points{};
    GDALInitGCPs(4, points.data());
    for (std::size_t i = 0; i < 4; ++i) {
      points[i].dfGCPPixel = i % 2 == 0 ? 0.0 : 64.0;
      points[i].dfGCPLine = i < 2 ? 0.0 : 64.0;
      points[i].dfGCPX = 583000.0 + 2.0 * points[i].dfGCPPixel;
      points[i].dfGCPY = 4357000.0 - 2.0 * points[i].dfGCPLine;
    }
    OGRSpatialReference utm;
    utm.importFromEPSG(32616);
    ASSERT_EQ(dataset->SetGCPs(4, points.data(), &utm), CE_None);
    GDALDeinitGCPs(4, points.data());
  }
  const auto world = open_world(spec_over(file));
  ASSERT_FALSE(world);
  EXPECT_THAT(world.error().message,
              AllOf(HasSubstr("points.tif"),
                    HasSubstr("only 4 ground control points"),
                    HasSubstr("gdalwarp")));
}

TEST(Georeference, InALocalSystemIsReplacedByTheManifests) {
  TemporaryFolder folder;
  RasterFile picture;
  testing::write_raster(folder.path() / "utm.tif", picture);
  picture.crs = R"(LOCAL_CS["site",UNIT["metre",1]])";
  testing::write_raster(folder.path() / "site.tif", picture);
  WorldSpec spec = spec_over(folder.path() / "site.tif");
  const auto local = open_world(spec);
  ASSERT_FALSE(local);
  EXPECT_THAT(local.error().message, AllOf(HasSubstr("a local one"), HasSubstr("field \"crs\"")));
  spec.imagery[0].crs = "EPSG:32616";
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  const auto utm = open_world(spec_over(folder.path() / "utm.tif"));
  ASSERT_TRUE(utm) << utm.error().message;
  EXPECT_EQ(world->tiles->frame().origin().lat_rad, utm->tiles->frame().origin().lat_rad);
  EXPECT_EQ(world->tiles->frame().origin().lon_rad, utm->tiles->frame().origin().lon_rad);
}

}  // namespace
}  // namespace overfly::terrain
