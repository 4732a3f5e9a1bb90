// Files next to a raster that GDAL looks for: only regular ones inside the data folders are used.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "terrain/files/side_cars.hpp"
#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/terrain/raster_file.hpp"

namespace overfly::terrain {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::RasterFile;
using testing::TemporaryFolder;

/// Waiting for the writer of a FIFO, a test would never end.
class SideCarsTest : public ::testing::Test {
 protected:
  SideCarsTest() { fs::create_directories(root() / "data"); }

  [[nodiscard]] const fs::path& root() const { return folder_.path(); }
  [[nodiscard]] fs::path data(const std::string& name) const { return root() / "data" / name; }
  void make_fifo(const std::string& name) const {
    ASSERT_EQ(::mkfifo(data(name).c_str(), 0600), 0) << name;
  }
  [[nodiscard]] static WorldSpec over(const fs::path& imagery) {
    WorldSpec spec;
    spec.imagery.emplace_back().file = imagery;
    spec.ground_height_m = 200.0;
    return spec;
  }

  TemporaryFolder folder_;
};

TEST_F(SideCarsTest, ThatAreNoFilesAreLeftOutWithAWarning) {
  const struct {
    const char* driver;
    const char* file;
    std::vector<std::string> side_cars;
    std::vector<std::string> options;
  } kinds[] = {
      {"GTiff",
       "x.tif",
       {"x.tif.aux.xml", "x.tif.ovr", "x.tif.msk", "x.tfw", "x.wld", "x.prj", "x.tab", "x.IMD"},
       {}},
      {"PNG", "y.png", {"y.wld", "y.pgw", "y.png.msk", "y.png.ovr"}, {}},
      {"JPEG", "z.jpg", {"z.wld", "z.jgw", "z.jpg.msk", "z.jpg.ovr"}, {}},
      {"ENVI", "e.img", {"e.prj", "e.img.ovr", "e.aux", "e.sta"}, {}},
      {"EHdr", "h.bil", {"h.stx", "h.clr", "h.blw", "h.bil.ovr"}, {}},
      {"HFA", "f.img", {"f.rrd", "f.ige", "f.img.aux.xml", "f.img.ovr", "f.prj"}, {}},
      {"SAGA", "s.sdat", {"s.mgrd", "s.sdat.msk"}, {}},
      {"AAIGrid", "g.asc", {"g.PRJ", "g.asc.ovr"}, {}},
  };
  for (const auto& kind : kinds) {
    SCOPED_TRACE(kind.driver);
    RasterFile raster;
    raster.driver = kind.driver;
    if (raster.driver == "SAGA") raster.type = "Float32";
    if (raster.driver == "AAIGrid") raster.type = "Int32";
    raster.options = kind.options;
    testing::write_raster(data(kind.file), raster);
    WorldSpec spec = over(data(kind.file));
    spec.imagery.back().crs = "EPSG:32616";
    for (const std::string& name : kind.side_cars) {
      if (!fs::exists(data(name))) make_fifo(name);
    }
    const auto world = open_world(spec);
    ASSERT_TRUE(world.ok()) << world.error().message;
    for (const std::string& name : kind.side_cars) {
      if (!fs::is_fifo(data(name))) continue;
      EXPECT_THAT(
          world->warnings,
          Contains(HasSubstr(data(name).string() + ": is not a regular file and is ignored")));
    }
  }
}

TEST_F(SideCarsTest, ThatAreNoFilesAreNotWaitedForInPlaceOfNeededOnes) {
  RasterFile raster;
  raster.driver = "ENVI";
  testing::write_raster(data("e.img"), raster);
  fs::remove(data("e.hdr"));
  make_fifo("e.hdr");
  const auto world = open_world(over(data("e.img")));
  ASSERT_FALSE(world.ok());
  EXPECT_THAT(world.error().message, HasSubstr("e.hdr: is not a regular file and is ignored"));
}

TEST_F(SideCarsTest, OfAMosaicsSourcesAreLeftOutToo) {
  testing::write_raster(data("a.tif"), RasterFile());
  testing::write_text(data("all.vrt"),
                      "<VRTDataset rasterXSize=\"64\" rasterYSize=\"64\"><SRS>EPSG:32616</SRS>"
                      "<GeoTransform>583000, 2, 0, 4357000, 0, -2</GeoTransform>"
                      "<VRTRasterBand dataType=\"Byte\" band=\"1\"><SimpleSource>"
                      "<SourceFilename relativeToVRT=\"1\">a.tif</SourceFilename>"
                      "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>");
  make_fifo("a.tif.aux.xml");
  make_fifo("a.tif.ovr");
  const auto world = open_world(over(data("all.vrt")));
  ASSERT_TRUE(world.ok()) << world.error().message;
  EXPECT_THAT(world->warnings, Contains(HasSubstr("a.tif.ovr: is not a regular file")));

  fs::remove(data("a.tif.ovr"));
  testing::write_raster(root() / "secret.tif", RasterFile());
  fs::create_symlink(root() / "secret.tif", data("a.tif.ovr"));
  const auto leading_out = open_world(over(data("all.vrt")));
  ASSERT_FALSE(leading_out.ok());
  EXPECT_THAT(leading_out.error().message, HasSubstr("leads out of its folder: a.tif"));
}

TEST_F(SideCarsTest, OfAConfinedWorldLieInsideTheDataFolders) {
  testing::write_raster(data("a.tif"), RasterFile());
  testing::write_raster(root() / "secret.tif", RasterFile());
  WorldSpec confined = over(data("a.tif"));
  confined.sources = SourcePolicy::inside({root() / "data"});
  for (const char* name : {"a.tif.ovr", "a.tif.msk", "a.tif.aux.xml", "a.tfw", "A.PRJ"}) {
    for (const char* target : {"secret.tif", "absent.tif"}) {
      fs::create_symlink(root() / target, data(name));
      const auto world = open_world(confined);
      ASSERT_FALSE(world.ok()) << name;
      EXPECT_EQ(world.error().message,
                "imagery.0.file (a file next to it) = " + data(name).string() +
                    ": must be a file inside of the server's data folders");
      fs::remove(data(name));
    }
  }
  // There are other files next to it.
  fs::create_symlink(root() / "secret.tif", data("ab.tif"));
  fs::create_symlink(root() / "secret.tif", data("b.ovr"));
  fs::create_directory(data("a.folder"));
  fs::create_symlink(data("a.tif"), data("a.again.tif"));
  const auto world = open_world(confined);
  EXPECT_TRUE(world.ok()) << world.error().message;
  EXPECT_THAT(world->warnings, Not(Contains(HasSubstr("is ignored"))));
}

}  // namespace
}  // namespace overfly::terrain
