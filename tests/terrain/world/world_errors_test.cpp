// Files that are broken, or that leave something open, are named and never placed wrongly.
#include <gtest/gtest.h>

#include <fstream>

#include "core/motion/pose.hpp"
#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/support/synthetic_world.hpp"

namespace overfly::terrain {
namespace {

using testing::GeoTiff;
using testing::TemporaryFolder;
using ::testing::Test;

class WorldErrors : public Test {
 protected:
  std::filesystem::path image(const std::string& name,
                              const std::string& crs = "EPSG:32616",
                              double left = 583000.0,
                              double top = 4357000.0) {
    GeoTiff tiff;
    tiff.image = testing::textured_image(300, 300, 1);
    tiff.crs = crs;
    tiff.left = left;
    tiff.top = top;
    tiff.pixel = 2.0;
    const auto file = folder_.path() / name;
    testing::write_geotiff(file, tiff);
    return file;
  }
  static WorldSpec spec_of(const std::filesystem::path& imagery) {
    WorldSpec spec;
    spec.imagery.push_back({imagery, "", {}});
    spec.ground_height_m = 100.0;
    return spec;
  }
  static std::string error_of(const WorldSpec& spec) {
    const auto world = open_world(spec);
    return world ? "no error" : world.error().message;
  }
  static ElevationLayer elevation(const std::filesystem::path& file) {
    ElevationLayer layer;
    layer.file = file;
    layer.datum = VerticalDatum::kEllipsoid;
    return layer;
  }

  TemporaryFolder folder_;
};

TEST_F(WorldErrors, ACorruptGeoreferenceIsAClearErrorAsElevationAndAsImagery) {
  OVERFLY_DATA_OR_SKIP(corrupt, "terrain/goleta/elevation_corrupt_georef.tif");
  OVERFLY_DATA_OR_SKIP(photo, "terrain/goleta/ortho_epsg4326.tif");
  WorldSpec spec = spec_of(photo);
  spec.elevation.push_back(elevation(corrupt));
  for (const WorldSpec& bad : {spec, spec_of(corrupt)}) {
    const std::string error = error_of(bad);
    EXPECT_NE(error.find("elevation_corrupt_georef.tif"), std::string::npos) << error;
    EXPECT_NE(error.find("no coordinate reference system"), std::string::npos) << error;
    EXPECT_NE(error.find("corrupt"), std::string::npos) << "GDAL's own words: " << error;
  }
}

TEST_F(WorldErrors, ACrsSaidInTheManifestStandsInForAMissingOne) {
  OVERFLY_DATA_OR_SKIP(corrupt, "terrain/goleta/elevation_corrupt_georef.tif");
  OVERFLY_DATA_OR_SKIP(photo, "terrain/goleta/ortho_epsg4326.tif");
  OVERFLY_DATA_OR_SKIP(good, "terrain/goleta/elevation_epsg4326.tif");
  WorldSpec spec = spec_of(photo);
  spec.elevation.push_back(elevation(corrupt));
  spec.elevation.back().crs = "EPSG:4326";
  const auto repaired = open_world(spec);
  ASSERT_TRUE(repaired) << repaired.error().message;
  spec.elevation = {elevation(good)};
  const auto right = open_world(spec);
  ASSERT_TRUE(right) << right.error().message;
  EXPECT_DOUBLE_EQ(repaired->tiles->ground_up_m(123.0, -45.0),
                   right->tiles->ground_up_m(123.0, -45.0));
  spec.elevation.front() = elevation(corrupt);
  spec.elevation.front().crs = "EPSG:no";
  EXPECT_NE(error_of(spec).find("crs = \"EPSG:no\""), std::string::npos) << error_of(spec);
}

TEST_F(WorldErrors, AMissingFileIsNotFound) {
  const auto world = open_world(spec_of(folder_.path() / "nowhere.tif"));
  ASSERT_FALSE(world);
  EXPECT_EQ(world.error().code, ErrorCode::kNotFound);
  EXPECT_NE(world.error().message.find("nowhere.tif"), std::string::npos);
}

TEST_F(WorldErrors, AFileThatIsNoRasterIsUnreadable) {
  testing::write_text(folder_.path() / "text.tif", "not a picture");
  const auto world = open_world(spec_of(folder_.path() / "text.tif"));
  ASSERT_FALSE(world);
  EXPECT_EQ(world.error().code, ErrorCode::kUnreadable);
  EXPECT_NE(world.error().message.find("text.tif"), std::string::npos);
}

TEST_F(WorldErrors, ATruncatedFileIsUnreadable) {
  const auto whole = image("whole.tif");
  std::string bytes = testing::read_text(whole);
  testing::write_text(folder_.path() / "half.tif", bytes.substr(0, bytes.size() / 2));
  const std::string error = error_of(spec_of(folder_.path() / "half.tif"));
  EXPECT_NE(error.find("half.tif"), std::string::npos) << error;
  WorldSpec spec = spec_of(whole);
  ImageBuffer<float> posts(400, 400, 1, 5.0F);
  testing::write_elevation(
      folder_.path() / "posts.tif", posts, "EPSG:32616", 582800.0, 4357200.0, 2.5);
  bytes = testing::read_text(folder_.path() / "posts.tif");
  testing::write_text(folder_.path() / "posts.tif", bytes.substr(0, bytes.size() * 3 / 4));
  spec.elevation.push_back(elevation(folder_.path() / "posts.tif"));
  const std::string heights = error_of(spec);
  EXPECT_NE(heights.find("posts.tif"), std::string::npos) << heights;
}

TEST_F(WorldErrors, ElevationElsewhereIsAnErrorAndPartlyElsewhereAWarning) {
  ImageBuffer<float> posts(50, 50, 1, 120.0F);
  const auto file = folder_.path() / "posts.tif";
  WorldSpec spec = spec_of(image("image.tif"));
  spec.elevation.push_back(elevation(file));
  testing::write_elevation(file, posts, "EPSG:32616", 783000.0, 4357000.0, 10.0);
  EXPECT_NE(error_of(spec).find("posts.tif"), std::string::npos) << error_of(spec);
  testing::write_elevation(file, posts, "EPSG:32616", 585000.0, 4357000.0, 10.0);
  EXPECT_NE(error_of(spec).find("does not overlap"), std::string::npos) << error_of(spec);
  testing::write_elevation(file, posts, "EPSG:32616", 583300.0, 4357000.0, 10.0);
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  ASSERT_EQ(world->warnings.size(), 1U);
  EXPECT_NE(world->warnings[0].find("covers 4"), std::string::npos) << world->warnings[0];
}

TEST_F(WorldErrors, AnUnknownVerticalDatumWarnsOfTheErrorsSize) {
  ImageBuffer<float> posts(100, 100, 1, 200.0F);
  testing::write_elevation(
      folder_.path() / "posts.tif", posts, "EPSG:32616", 582800.0, 4357200.0, 10.0);
  WorldSpec spec = spec_of(image("image.tif"));
  spec.elevation.push_back({folder_.path() / "posts.tif", VerticalDatum::kUnknown, {}, {}, "", {}});
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  ASSERT_EQ(world->warnings.size(), 1U);
  // The geoid lies 33 m below the ellipsoid in Indiana.
  EXPECT_NE(world->warnings[0].find("vertical datum is not given"), std::string::npos);
  EXPECT_NE(world->warnings[0].find(" 33."), std::string::npos) << world->warnings[0];
}

TEST_F(WorldErrors, AnEmptyWorldAndBadNumbersNameTheField) {
  EXPECT_NE(error_of(WorldSpec{}).find("imagery"), std::string::npos);
  WorldSpec spec = spec_of(image("image.tif"));
  spec.ground_height_m = 1e6;
  EXPECT_NE(error_of(spec).find("ground_height_m = 1000000"), std::string::npos);
  spec.ground_height_m = 100.0;
  spec.origin = geodetic_from_deg(-39.0, 20.0, 0.0);
  EXPECT_NE(error_of(spec).find("origin"), std::string::npos) << error_of(spec);
}

TEST_F(WorldErrors, ImageryOnTwoContinentsIsRefused) {
  WorldSpec spec = spec_of(image("a.tif"));
  spec.imagery.push_back({image("b.tif", "EPSG:32633", 500000.0, 5000000.0), "", {}});
  const std::string error = error_of(spec);
  EXPECT_NE(error.find("b.tif"), std::string::npos) << error;
}

TEST_F(WorldErrors, NoElevationAtAllIsAWarning) {
  WorldSpec spec = spec_of(image("image.tif"));
  spec.ground_height_m.reset();
  const auto world = open_world(spec);
  ASSERT_TRUE(world) << world.error().message;
  EXPECT_EQ(world->warnings.size(), 1U);
}

TEST_F(WorldErrors, TheDescriptionNamesLayersDatumGapsAndWarnings) {
  ImageBuffer<float> posts(100, 100, 1, 200.0F);
  testing::write_elevation(
      folder_.path() / "posts.tif", posts, "EPSG:32616", 582800.0, 4357200.0, 10.0);
  WorldSpec spec = spec_of(image("image.tif"));
  spec.imagery.front().attribution = "Test picture";
  spec.elevation.push_back({folder_.path() / "posts.tif", VerticalDatum::kUnknown, {}, {}, "", {}});
  const auto world = open_world(spec);
  ASSERT_TRUE(world);
  const std::string text = describe(*world);
  for (const char* part : {"600 x 600 m",
                           "2 m per texel",
                           "EPSG:32616",
                           "texel for texel",
                           "posts.tif, vertical datum unknown",
                           "imagery gaps: 0 %",
                           "warning: ",
                           "attribution: Test picture"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  }
  ASSERT_EQ(world->data_hashes.size(), 2U);
  EXPECT_EQ(world->data_hashes[0].second.substr(0, 7), "sha256:");
}

}  // namespace
}  // namespace overfly::terrain
