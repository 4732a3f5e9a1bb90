// The words of every error and warning about files that are broken, or not what they seem.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/terrain/raster_file.hpp"

namespace overfly::terrain {
namespace {

namespace fs = std::filesystem;
using testing::RasterFile;
using testing::TemporaryFolder;

constexpr double kEastM = 583000.0;
constexpr double kNorthM = 4357000.0;

/// A picture of 600 x 600 m in UTM zone 16.
RasterFile picture() {
  RasterFile raster;
  raster.width_px = raster.height_px = 300;
  return raster;
}

/// Heights around it.
RasterFile heights() {
  RasterFile raster;
  raster.type = "Float32";
  raster.width_px = raster.height_px = 100;
  raster.transform = {{kEastM - 200.0, 10.0, 0.0, kNorthM + 200.0, 0.0, -10.0}};
  raster.value = [](int x, int y, int) { return 200.0 + std::sin(0.1 * x) + 0.1 * y; };
  return raster;
}

struct Broken {
  const char* what;
  std::function<void(RasterFile&)> change;
  std::string text;          ///< "error: ..." or "warning: ...", with the file's name and no folder
  const char* file = "bad";  ///< its name
  double kept_share = 1.0;   ///< of its bytes
};

/// An expected text that ends with * goes on with GDAL's own words.
::testing::AssertionResult fits(const std::string& said, const std::string& expected) {
  const bool open = expected.ends_with("*");
  const std::string start = expected.substr(0, expected.size() - (open ? 1 : 0));
  if (open ? said.starts_with(start) && said.size() > start.size() : said == expected) {
    return ::testing::AssertionSuccess();
  }
  return ::testing::AssertionFailure() << "said:     " << said << "\nexpected: " << expected;
}

class BrokenInput : public ::testing::Test {
 protected:
  void SetUp() override {
    testing::write_raster(folder_.path() / "picture.tif", picture());
    testing::write_raster(folder_.path() / "heights.tif", heights());
  }

  fs::path write(const Broken& broken, RasterFile raster) {
    const fs::path file = folder_.path() / broken.file;
    fs::remove(file);
    broken.change(raster);
    testing::write_raster(file, raster);
    const std::string bytes = testing::read_text(file);
    const auto kept =
        static_cast<std::size_t>(broken.kept_share * static_cast<double>(bytes.size()));
    if (broken.kept_share < 1.0) testing::write_text(file, bytes.substr(0, kept));
    return file;
  }

  /// All that is said about a world, one a line.
  std::string said(const WorldSpec& spec) {
    const auto world = open_world(spec);
    std::string text;
    if (!world) text = "error: " + world.error().message;
    if (world) {
      for (const std::string& warning : world->warnings) {
        text += std::string(text.empty() ? "" : "\n") + "warning: " + warning;
      }
    }
    const std::string folder = folder_.path().string() + "/";
    for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder)) {
      text.erase(at, folder.size());
    }
    return text;
  }

  WorldSpec over(const fs::path& imagery) {
    WorldSpec spec;
    spec.imagery.emplace_back().file = imagery;
    spec.ground_height_m = 200.0;
    return spec;
  }
  WorldSpec under(const fs::path& elevation) {
    WorldSpec spec = over(folder_.path() / "picture.tif");
    spec.ground_height_m.reset();
    spec.elevation.emplace_back().file = elevation;
    spec.elevation.back().datum = VerticalDatum::kEllipsoid;
    return spec;
  }

  TemporaryFolder folder_;
};

TEST_F(BrokenInput, GoodFilesAreNotSpokenOf) {
  EXPECT_EQ(said(over(folder_.path() / "picture.tif")), "");
  EXPECT_EQ(said(under(folder_.path() / "heights.tif")), "");
}

TEST_F(BrokenInput, AsImageryIsNamedInTheseWords) {
  const Broken all[] = {
      {"no CRS",
       [](RasterFile& r) { r.crs = ""; },
       "error: bad: has no coordinate reference system; set it in the manifest's field \"crs\", "
       "for example \"EPSG:4326\""},
      {"no position",
       [](RasterFile& r) { r.transform.reset(); },
       "error: bad: has no georeference (no position and pixel size)"},
      {"a pixel without size",
       [](RasterFile& r) {
         r.transform = {{kEastM, 0.0, 0.0, kNorthM, 0.0, 0.0}};
       },
       "error: bad: georeference is degenerate: pixel size (0.000000, 0.000000)"},
      {"a position that is no number",
       [](RasterFile& r) {
         r.transform = {{std::nan(""), 2.0, 0.0, kNorthM, 0.0, -2.0}};
       },
       "error: bad: georeference is invalid: a corner lies at (nan, 4357000.000000), outside its "
       "coordinate reference system"},
      {"metres that are said to be degrees",
       [](RasterFile& r) { r.crs = "EPSG:4326"; },
       "error: bad: georeference is invalid: a corner lies at (583000.000000, 4357000.000000), "
       "outside its coordinate reference system"},
      {"degrees that are said to be metres",
       [](RasterFile& r) {
         r.transform = {{-86.0, 2e-5, 0.0, 39.3, 0.0, -2e-5}};
       },
       "error: bad: pixels are 2e-05 m on the ground: must be in [0.001, 100000]; is its "
       "georeference in the unit of its coordinate reference system (metre)?"},
      {"feet that are said to be metres",
       [](RasterFile& r) {
         r.transform = {{kEastM / 0.3048, 6.56, 0.0, kNorthM / 0.3048, 0.0, -6.56}};
       },
       "warning: bad: its centre lies at 49.7719 deg N, 73.2952 deg E, 157 deg outside the area of "
       "its coordinate reference system (0 to 84 deg N, -90 to -84 deg E); are its coordinates in "
       "the right unit and zone?"},
      {"one colour",
       [](RasterFile& r) { r.value = [](int, int, int) { return 0.0; }; },
       "warning: bad: all of 1024 samples have one colour (0, 0, 0); is it an empty tile?"},
      {"nothing but nodata",
       [](RasterFile& r) {
         r.value = [](int, int, int) { return 0.0; };
         r.nodata = 0.0;
       },
       "error: bad: every texel is void by its mask or nodata value: there is no picture to fly "
       "over"},
      {"complex numbers",
       [](RasterFile& r) { r.type = "CFloat32"; },
       "error: bad: has complex samples, not an image"},
      {"a cut GeoTIFF",
       [](RasterFile&) {},
       "error: cut.tif: is truncated: block 0_6 ends at byte 57132, the file has 54259",
       "cut.tif",
       0.6},
      {"a cut GeoTIFF, band by band",
       [](RasterFile& r) {
         r.bands = 3;
         r.options = {"INTERLEAVE=BAND"};
       },
       "error: cut.tif: is truncated: block 0_7 ends at byte 245654, the file has 243768",
       "cut.tif",
       0.9},
      {"a cut PNG",
       [](RasterFile& r) { r.driver = "PNG"; },
       "error: cut.png: its last row cannot be read: libpng: Read Error*",
       "cut.png",
       0.6},
      {"a cut JPEG",
       [](RasterFile& r) { r.driver = "JPEG"; },
       "warning: cut.jpg: may be damaged; GDAL reported on reading its last row: libjpeg: "
       "Premature end "
       "of JPEG file*",
       "cut.jpg",
       0.6},
      {"a cut JPEG 2000",
       [](RasterFile& r) { r.driver = "JP2OpenJPEG"; },
       "error: cut.jp2: its last row cannot be read: *",
       "cut.jp2",
       0.6},
      {"a cut Erdas file",
       [](RasterFile& r) { r.driver = "HFA"; },
       "error: cut.img: not a readable raster: *",
       "cut.img",
       0.6},
      {"no bytes at all",
       [](RasterFile&) {},
       "error: empty.tif: is empty (0 bytes)",
       "empty.tif",
       0.0},
  };
  for (const Broken& broken : all) {
    EXPECT_TRUE(fits(said(over(write(broken, picture()))), broken.text)) << broken.what;
  }
}

TEST_F(BrokenInput, AsElevationIsNamedInTheseWords) {
  const Broken all[] = {
      {"no CRS",
       [](RasterFile& r) { r.crs = ""; },
       "error: bad: has no coordinate reference system; set it in the manifest's field \"crs\", "
       "for example \"EPSG:4326\""},
      {"metres that are said to be degrees",
       [](RasterFile& r) { r.crs = "EPSG:4326"; },
       "error: bad: georeference is invalid: a corner lies at (582800.000000, 4357200.000000), "
       "outside its coordinate reference system"},
      {"elsewhere",
       [](RasterFile& r) { (*r.transform)[0] += 3000.0; },
       "error: bad: elevation does not overlap the imagery; check both georeferences (*"},
      {"in another zone",
       [](RasterFile& r) { r.crs = "EPSG:32617"; },
       "error: bad: elevation lies nowhere near the imagery; check both georeferences (*"},
      {"over a part of the imagery",
       [](RasterFile& r) { (*r.transform)[0] += 500.0; },
       "warning: bad: elevation covers 50 % of the imagery; beyond, the ground continues with "
       "the edge's height"},
      {"8 bits",
       [](RasterFile& r) {
         r.type = "Byte";
         r.value = [](int x, int y, int) { return (x + y) % 256; };
       },
       "warning: bad: elevation has 8 bits: 256 heights in steps of one unit, so it may be a "
       "shaded relief image; the ground will have terraces"},
      {"a picture",
       [](RasterFile& r) {
         r.type = "Byte";
         r.bands = 3;
         r.value = {};
       },
       "error: bad: is an image (8-bit colours), not elevation; is it listed in the wrong place?"},
      {"heights of a map in feet",
       [](RasterFile& r) {
         r.crs = "+proj=utm +zone=16 +datum=WGS84 +units=us-ft";
         for (double& value : *r.transform) value *= 3937.0 / 1200.0;
       },
       "warning: bad: unit of the heights is not given; metres are assumed. If they are feet, the "
       "ground is 3.28 times too high: set \"unit_m\" in the manifest"},
      {"an unknown unit",
       [](RasterFile& r) { r.unit = "cm"; },
       "warning: bad: unit of the heights is \"cm\", which is unknown; metres are assumed: set "
       "\"unit_m\" in the manifest if that is wrong"},
      {"heights in millimetres",
       [](RasterFile& r) { r.value = [](int x, int, int) { return 200000.0 + x; }; },
       "error: bad: has no heights near the imagery, only values outside -12000 to 9000 m; if "
       "their unit is not the metre, set \"unit_m\" in the manifest"},
      {"some heights beyond reason",
       [](RasterFile& r) {
         r.value = [](int x, int y, int) { return x == 50 && y < 10 ? 32767.0 : 200.0; };
       },
       "warning: bad: 10 heights outside -12000 to 9000 m are treated as missing\nwarning: bad: 10 "
       "of 10000 posts (0.10 %) have no data and are filled from those around them"},
      {"nothing but nodata",
       [](RasterFile& r) {
         r.value = [](int, int, int) { return -9999.0; };
         r.nodata = -9999.0;
       },
       "error: bad: has no heights near the imagery"},
      {"some nodata",
       [](RasterFile& r) {
         r.value = [](int x, int y, int) { return x == 50 && y < 10 ? -9999.0 : 200.0; };
         r.nodata = -9999.0;
       },
       "warning: bad: 10 of 10000 posts (0.10 %) have no data and are filled from those around "
       "them"},
      {"complex numbers",
       [](RasterFile& r) { r.type = "CFloat32"; },
       "error: bad: has complex samples, not heights"},
      {"a cut GeoTIFF",
       [](RasterFile&) {},
       "error: cut.tif: is truncated: block 0_2 ends at byte 24390, the file has 24234",
       "cut.tif",
       0.6},
      {"a cut Erdas file",
       [](RasterFile& r) { r.driver = "HFA"; },
       "error: cut.img: not a readable raster: *",
       "cut.img",
       0.6},
      {"no bytes at all",
       [](RasterFile&) {},
       "error: empty.tif: is empty (0 bytes)",
       "empty.tif",
       0.0},
  };
  for (const Broken& broken : all) {
    EXPECT_TRUE(fits(said(under(write(broken, heights()))), broken.text)) << broken.what;
  }
}

TEST_F(BrokenInput, BehindAVirtualRasterIsNamed) {
  const auto write_vrt = [&](const std::string& source) {
    testing::write_text(folder_.path() / "all.vrt",
                        R"(<VRTDataset rasterXSize="300" rasterYSize="300"><SRS>EPSG:32616</SRS>
<GeoTransform>583000, 2, 0, 4357000, 0, -2</GeoTransform>
<VRTRasterBand dataType="Byte" band="1"><SimpleSource>
<SourceFilename relativeToVRT="1">)" +
                            source + R"(</SourceFilename><SourceBand>1</SourceBand>
</SimpleSource></VRTRasterBand></VRTDataset>)");
    return said(over(folder_.path() / "all.vrt"));
  };
  EXPECT_EQ(write_vrt("picture.tif"), "");
  EXPECT_EQ(write_vrt("gone.tif"), "error: all.vrt: is made of: gone.tif: no such file");
  const Broken cut{"", [](RasterFile&) {}, "", "cut.tif", 0.6};
  (void)write(cut, picture());
  EXPECT_EQ(write_vrt("cut.tif"),
            "error: all.vrt: is made of: cut.tif: is truncated: block 0_6 ends at byte 57132, the "
            "file has 54259");
}

TEST_F(BrokenInput, OfAnySizeThatADescriptionDeclaresIsNamed) {
  const auto said_of = [&](const std::string& width, const std::string& height) {
    testing::write_text(folder_.path() / "vast.vrt",
                        "<VRTDataset rasterXSize=\"" + width + "\" rasterYSize=\"" + height +
                            R"("><SRS>EPSG:32616</SRS>
<GeoTransform>583000, 0.001, 0, 4357000, 0, -0.001</GeoTransform>
<VRTRasterBand dataType="Byte" band="1"><NoDataValue>0</NoDataValue></VRTRasterBand>
</VRTDataset>)");
    return said(over(folder_.path() / "vast.vrt"));
  };
  const std::string limit = " texels: must be at most 1073741824 along a side and 1e13 in all";
  EXPECT_EQ(said_of("400000000", "400000000"), "error: vast.vrt: 400000000 x 400000000" + limit);
  EXPECT_EQ(said_of("4000000", "4000000"), "error: vast.vrt: 4000000 x 4000000" + limit);
  EXPECT_EQ(said_of("2147483647", "1"), "error: vast.vrt: 2147483647 x 1" + limit);
}

TEST_F(BrokenInput, OfElevationFormatsIsNamedWhenCutShort) {
  OVERFLY_DATA_OR_SKIP(hgt, "terrain/elevation_formats/N44W072.hgt");
  OVERFLY_DATA_OR_SKIP(dem, "terrain/elevation_formats/mtsthelens_after_usgs.dem");
  for (const fs::path& whole : {hgt, dem}) {
    const std::string bytes = testing::read_text(whole);
    testing::write_text(folder_.path() / whole.filename(), bytes.substr(0, bytes.size() / 2));
    RasterFile raster = picture();
    const bool is_hgt = whole == hgt;
    raster.crs = is_hgt ? "EPSG:32619" : "EPSG:26910";
    raster.transform = {
        {is_hgt ? 301290.0 : 562710.0, 2.0, 0.0, is_hgt ? 4930250.0 : 5114985.0, 0.0, -2.0}};
    testing::write_raster(folder_.path() / "picture.tif", raster);
    EXPECT_TRUE(fits(said(under(folder_.path() / whole.filename())),
                     "error: " + whole.filename().string() + "*"));
  }
}

}  // namespace
}  // namespace overfly::terrain
