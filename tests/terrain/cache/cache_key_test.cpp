// What a cache depends on: every file that GDAL reads, and the places that PROJ finds.
#include "terrain/cache/cache_key.hpp"

#include "terrain/world/raster_world.hpp"
#include "terrain/world/world_files.hpp"
#include "tests/terrain/cache/built_world.hpp"
#include "tests/terrain/raster_file.hpp"

namespace overfly::terrain {
namespace {

using ::testing::Contains;
using ::testing::Not;
using testing::RasterFile;

class SourceFiles : public ::testing::Test {
 protected:
  SourceFiles() {
    fs::create_directories(at("parts"));
    testing::write_raster(at("parts/a.tif"), RasterFile());
    // Not every virtual raster is named so.
    testing::write_text(at("parts/inner.dat"), mosaic("a.tif"));
    testing::write_text(at("all.vrt"), mosaic("parts/inner.dat"));
    spec_.imagery.emplace_back().file = at("all.vrt");
    spec_.ground_height_m = 200.0;
    spec_.cache_folder = at("world.cache");
  }
  [[nodiscard]] fs::path at(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] static std::string mosaic(const std::string& source) {
    return "<VRTDataset rasterXSize=\"64\" rasterYSize=\"64\"><SRS>EPSG:32616</SRS>"
           "<GeoTransform>583000, 2, 0, 4357000, 0, -2</GeoTransform>"
           "<VRTRasterBand dataType=\"Byte\" band=\"1\"><SimpleSource>"
           "<SourceFilename relativeToVRT=\"1\">" +
           source +
           "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand>"
           "</VRTDataset>";
  }
  [[nodiscard]] std::vector<std::string> in_cache_key() const {
    std::vector<std::string> names;
    const auto sources = cache_sources(spec_).value();
    for (const CacheSource& source : sources) names.push_back(source.file);
    return names;
  }

  TemporaryFolder folder_;
  WorldSpec spec_;
};

TEST_F(SourceFiles, AreThoseOfTheSourcesOfAVirtualRasterToo) {
  EXPECT_THAT(in_cache_key(),
              ::testing::UnorderedElementsAre("all.vrt", "parts/inner.dat", "parts/a.tif"));
  testing::write_text(at("parts/a.tif.aux.xml"), "<PAMDataset></PAMDataset>");
  testing::write_text(at("parts/b.tif.aux.xml"), "<PAMDataset></PAMDataset>");
  EXPECT_THAT(in_cache_key(), Contains("parts/a.tif.aux.xml"));
  EXPECT_THAT(in_cache_key(), Not(Contains("parts/b.tif.aux.xml")));
}

TEST_F(SourceFiles, AreWatchedAlsoBeforeTheyExist) {
  const std::vector<WorldFile> before = world_files(spec_);
  EXPECT_FALSE(changed_file(before));
  testing::write_raster(at("parts/a.tif.msk"), RasterFile());
  EXPECT_EQ(changed_file(before), at("parts/a.tif.msk"));
  EXPECT_FALSE(lost_file(before));
  const std::vector<WorldFile> after = world_files(spec_);
  testing::write_text(at("parts/a.tif.msk"), "other");
  EXPECT_EQ(changed_file(after), at("parts/a.tif.msk"));
}

class Fingerprint : public ::testing::Test {
 protected:
  /// Of two layers of imagery and two of heights, each second one in degrees, moved to the east.
  std::string fingerprint(double imagery_shift_deg, double heights_shift_deg) {
    const fs::path folder = folder_.path() / std::to_string(++count_);
    fs::create_directories(folder);
    RasterFile raster;
    testing::write_raster(folder / "near.tif", raster);
    raster.type = "Float32";
    raster.transform = {{582700.0, 20.0, 0.0, 4357300.0, 0.0, -20.0}};
    testing::write_raster(folder / "near_heights.tif", raster);
    raster.crs = "EPSG:4326";
    raster.transform = {{-86.06 + heights_shift_deg, 0.001, 0.0, 39.38, 0.0, -0.001}};
    testing::write_raster(folder / "far_heights.tif", raster);
    raster.type = "Byte";
    // The bounds of the grid stay the same.
    raster.transform = {{-86.037 + imagery_shift_deg, 1e-5, 0.0, 39.357, 0.0, -1e-5}};
    testing::write_raster(folder / "far.tif", raster);
    WorldSpec spec;
    for (const char* name : {"near", "far"}) {
      spec.imagery.emplace_back().file = folder / (std::string(name) + ".tif");
      spec.elevation.emplace_back().file = folder / (std::string(name) + "_heights.tif");
      spec.elevation.back().datum = VerticalDatum::kEllipsoid;
    }
    const World world = opened(spec);
    const auto& tiles = dynamic_cast<const RasterWorld&>(*world.tiles);
    return world_fingerprint(tiles.grid(), tiles.imagery(), tiles.elevation());
  }

 private:
  TemporaryFolder folder_;
  int count_ = 0;
};

TEST_F(Fingerprint, HoldsThePlaceOfEveryLayer) {
  const std::string first = fingerprint(0.0, 0.0);
  EXPECT_EQ(fingerprint(0.0, 0.0), first);
  EXPECT_NE(fingerprint(1e-6, 0.0), first) << "a tenth of a pixel";
  EXPECT_NE(fingerprint(0.0, 1e-6), first) << "a thousandth of the distance of posts";
}

}  // namespace
}  // namespace overfly::terrain
