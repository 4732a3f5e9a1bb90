// Opening a world ends soon when it is cancelled, however large a single file is.
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "terrain/raster/gdal_dataset.hpp"
#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/terrain/raster_file.hpp"

namespace overfly::terrain {
namespace {

namespace fs = std::filesystem;
using testing::RasterFile;
using testing::TemporaryFolder;

const std::vector<std::string> kSmallTiles = {
    "TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16", "COMPRESS=DEFLATE"};

class CancelledOpening : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path file(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] static RasterFile square(int side_px) {
    RasterFile raster;
    raster.width_px = side_px;
    raster.height_px = side_px;
    raster.transform = {{583000.0, 0.5, 0.0, 4357000.0, 0.0, -0.5}};
    raster.value = [](int x, int y, int) { return (x / 16 + y / 16) % 250; };
    raster.options = kSmallTiles;
    return raster;
  }
  /// Opens it, then again and again, cancelled ever later.
  /// @return how often the first opening asked whether it is cancelled
  static int expect_cancellable(const WorldSpec& spec) {
    int asked = 0;
    const auto whole = open_world(spec, [&] {
      ++asked;
      return false;
    });
    EXPECT_TRUE(whole.ok()) << (whole ? "" : whole.error().message);
    const int step = std::max(1, asked / 12);
    for (int after = 0; after < asked; after += step) {
      int count = 0;
      const auto world = open_world(spec, [&] { return count++ >= after; });
      EXPECT_FALSE(world.ok()) << after;
      if (world) continue;
      EXPECT_EQ(world.error().code, ErrorCode::kCancelled) << after << world.error().message;
      EXPECT_LE(count, after + 2) << "it went on";
    }
    return asked;
  }
  [[nodiscard]] static WorldSpec over(const fs::path& imagery) {
    WorldSpec spec;
    spec.imagery.emplace_back().file = imagery;
    spec.ground_height_m = 200.0;
    return spec;
  }

  TemporaryFolder folder_;
};

TEST_F(CancelledOpening, BetweenTheBlocksOfATable) {
  // 65 536 blocks, looked at once for unwritten ones and once for a file that is cut short.
  testing::write_raster(file("tiles.tif"), square(4096));
  EXPECT_GE(expect_cancellable(over(file("tiles.tif"))), 2 * 65536 / 4096);
}

TEST_F(CancelledOpening, BetweenTheBlocksOfAFileThatIsEmpty) {
  initialise_gdal();
  const char* options[] = {
      "TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16", "SPARSE_OK=TRUE", nullptr};
  {
    const GDALDatasetUniquePtr made(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        file("sparse.tif").c_str(), 4096, 4096, 1, GDT_Byte, const_cast<char**>(options)));
    double transform[] = {583000.0, 0.5, 0.0, 4357000.0, 0.0, -0.5};
    OGRSpatialReference crs;
    crs.importFromEPSG(32616);
    made->SetGeoTransform(transform);
    made->SetSpatialRef(&crs);
    std::vector<std::uint8_t> grey(256, 90);
    ASSERT_EQ(made->GetRasterBand(1)->WriteBlock(200, 200, grey.data()), CE_None);
  }
  // A table of 65 536 blocks, and a mask of 1024 rows of cells.
  EXPECT_GE(expect_cancellable(over(file("sparse.tif"))), 65536 / 4096 + 1024);
}

TEST_F(CancelledOpening, BetweenThePiecesOfAMask) {
  RasterFile masked = square(2048);
  masked.nodata = 7.0;
  testing::write_raster(file("masked.tif"), masked);
  EXPECT_GE(expect_cancellable(over(file("masked.tif"))), 1024);
}

TEST_F(CancelledOpening, BetweenTheRowsOfAFileThatIsDecodedFromItsStart) {
  RasterFile picture = square(1024);
  picture.driver = "PNG";
  picture.options = {};
  testing::write_raster(file("rows.png"), picture);
  // On the way to the last row.
  EXPECT_GE(expect_cancellable(over(file("rows.png"))), 255);
}

TEST_F(CancelledOpening, BetweenTheRowsOfASampleOf16Bit) {
  RasterFile picture = square(1024);
  picture.type = "UInt16";
  testing::write_raster(file("deep.tif"), picture);
  EXPECT_GE(expect_cancellable(over(file("deep.tif"))), 256);
}

TEST_F(CancelledOpening, BetweenTheSourcesOfAMosaic) {
  testing::write_raster(file("tile.tif"), square(64));
  std::string bands;
  constexpr int kSources = 100;
  for (int i = 0; i < kSources; ++i) {
    const std::string name = "tile" + std::to_string(i) + ".tif";
    fs::copy_file(file("tile.tif"), file(name));
    bands += "<SimpleSource><SourceFilename relativeToVRT=\"1\">" + name +
             "</SourceFilename><SourceBand>1</SourceBand><DstRect xOff=\"" +
             std::to_string(64 * i) + "\" yOff=\"0\" xSize=\"64\" ySize=\"64\"/></SimpleSource>";
  }
  testing::write_text(file("all.vrt"),
                      "<VRTDataset rasterXSize=\"6400\" rasterYSize=\"64\"><SRS>EPSG:32616</SRS>"
                      "<GeoTransform>583000, 0.5, 0, 4357000, 0, -0.5</GeoTransform>"
                      "<VRTRasterBand dataType=\"Byte\" band=\"1\">" +
                          bands + "</VRTRasterBand></VRTDataset>");
  EXPECT_GE(expect_cancellable(over(file("all.vrt"))), kSources);
}

}  // namespace
}  // namespace overfly::terrain
