// No file name makes GDAL use the network, unpack archives, or read outside the folder of the file.
#include <cpl_conv.h>
#include <cpl_http.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_srs_api.h>
#include <proj.h>
#include <sys/stat.h>

#include <cstdlib>
#include <set>

#include "terrain/files/network.hpp"
#include "terrain/raster/gdal_dataset.hpp"
#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/terrain/local_http_server.hpp"
#include "tests/terrain/raster_file.hpp"

namespace overfly::terrain {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::HttpAnswer;
using testing::HttpRequest;
using testing::LocalHttpServer;
using testing::RasterFile;
using testing::TemporaryFolder;

class OutsideAccess : public ::testing::Test {
 protected:
  OutsideAccess() {
    fs::create_directories(folder_.path() / "data");
    testing::write_raster(data("a.tif"), RasterFile());
    testing::write_raster(folder_.path() / "secret.tif", RasterFile());
  }
  ~OutsideAccess() override { EXPECT_EQ(server_.requests(), 0); }

  [[nodiscard]] fs::path data(const std::string& name) const {
    return folder_.path() / "data" / name;
  }
  /// A virtual raster around the elements of its one band.
  [[nodiscard]] std::string vrt(const std::string& band,
                                const std::string& of_band = "",
                                const std::string& of_set = "") const {
    return "<VRTDataset rasterXSize=\"64\" rasterYSize=\"64\"" + of_set +
           "><SRS>EPSG:32616</SRS><GeoTransform>583000, 2, 0, 4357000, 0, -2</GeoTransform>"
           "<VRTRasterBand dataType=\"Byte\" band=\"1\"" +
           of_band + ">" + band + "</VRTRasterBand></VRTDataset>";
  }
  [[nodiscard]] static std::string source(const std::string& name, bool relative = true) {
    return "<SimpleSource><SourceFilename relativeToVRT=\"" + std::string(relative ? "1" : "0") +
           "\">" + name + "</SourceFilename><SourceBand>1</SourceBand></SimpleSource>";
  }
  /// "ok", or the error of opening a file with this text as imagery.
  [[nodiscard]] std::string said(const std::string& text, const std::string& name = "all.vrt") {
    testing::write_text(data(name), text);
    WorldSpec spec;
    spec.imagery.push_back({data(name), "", {}});
    spec.ground_height_m = 200.0;
    const auto world = open_world(spec);
    return world ? "ok" : world.error().message;
  }
  [[nodiscard]] std::string address() const { return server_.address(); }
  [[nodiscard]] const fs::path& root() const { return folder_.path(); }

 private:
  TemporaryFolder folder_;
  LocalHttpServer server_{[](const HttpRequest&) { return HttpAnswer{}; }};
};

TEST_F(OutsideAccess, LeavesDriversOfLocalFilesOnly) {
  initialise_gdal();
  std::set<std::string> names;
  for (int i = 0; i < GetGDALDriverManager()->GetDriverCount(); ++i) {
    names.insert(GetGDALDriverManager()->GetDriver(i)->GetDescription());
  }
  for (const char* kept : {"GTiff", "VRT", "PNG", "JPEG", "HFA", "SRTMHGT", "USGSDEM", "AAIGrid"}) {
    EXPECT_TRUE(names.count(kept) > 0) << kept;
  }
  for (const char* gone : {"WMS",
                           "WMTS",
                           "WCS",
                           "HTTP",
                           "MRF",
                           "netCDF",
                           "HDF5",
                           "GPKG",
                           "STACIT",
                           "PostGISRaster",
                           "DERIVED",
                           "Zarr",
                           "PDF",
                           "ERS",
                           "PCIDSK"}) {
    EXPECT_EQ(GDALGetDriverByName(gone), nullptr) << gone;
  }
  EXPECT_LE(names.size(), 19U);
}

TEST_F(OutsideAccess, ClosesGdalsOtherFileSystems) {
  initialise_gdal();
  const CPLStringList prefixes(VSIGetFileSystemsPrefixes());
  int closed = 0;
  for (int i = 0; i < prefixes.size(); ++i) {
    const std::string prefix = prefixes[i];
    if (prefix == "/vsimem/" || prefix == "/vsisubfile/" || prefix == "/vsisparse/") continue;
    ++closed;
    const GdalMessages messages;
    EXPECT_EQ(VSIFOpenL((prefix + address() + "/a.tif").c_str(), "rb"), nullptr) << prefix;
    EXPECT_EQ(VSIFOpenL((prefix + data("a.tif").string()).c_str(), "rb"), nullptr) << prefix;
    VSIStatBufL facts;
    EXPECT_NE(VSIStatL((prefix + address() + "/a.tif").c_str(), &facts), 0) << prefix;
  }
  EXPECT_GE(closed, 10);
}

TEST_F(OutsideAccess, OfAVirtualRasterIsItsFolderAlone) {
  EXPECT_EQ(said(vrt(source("a.tif"))), "ok");
  for (const std::string& band : {source("/vsicurl/" + address() + "/a.tif"),
                                  source("/vsicurl/" + address() + "/a.tif", false),
                                  source(address() + "/a.tif"),
                                  source("../secret.tif"),
                                  source("sub/../../secret.tif"),
                                  source((root() / "secret.tif").string()),
                                  source((root() / "secret.tif").string(), false),
                                  source(data("a.tif").string(), false),
                                  source("/vsizip/a.zip/a.tif"),
                                  source("GTIFF_DIR:1:a.tif"),
                                  source("vrt://a.tif"),
                                  source("&lt;VRTDataset rasterXSize=\"1\" rasterYSize=\"1\"/>"),
                                  std::string("<Overview><SourceFilename relativeToVRT=\"1\">"
                                              "../secret.tif</SourceFilename></Overview>")}) {
    EXPECT_THAT(said(vrt(band)), HasSubstr("is made of a file that is not named relative")) << band;
  }
  EXPECT_THAT(said(vrt(source("a.tif"), "", " subClass=\"VRTWarpedDataset\"")),
              HasSubstr("may not be a VRTWarpedDataset"));
  EXPECT_THAT(said(vrt(source("a.tif") + "<PixelFunctionType>mul</PixelFunctionType>",
                       " subClass=\"VRTDerivedRasterBand\"")),
              HasSubstr("may not be a VRTDerivedRasterBand"));
  EXPECT_THAT(said(vrt("<SourceFilename relativeToVRT=\"1\">a.tif</SourceFilename>",
                       " subClass=\"VRTRawRasterBand\"")),
              HasSubstr("may not be a VRTRawRasterBand"));
  EXPECT_THAT(said(vrt("<PixelFunctionCode>x</PixelFunctionCode>")),
              HasSubstr("may not have the element pixelfunctioncode"));
  std::string option = source("a.tif");
  option.insert(option.find("<SourceBand>"),
                "<OpenOptions><OOI key=\"OVERVIEW_LEVEL\">NONE</OOI></OpenOptions>");
  EXPECT_EQ(said(vrt(option)), "ok");
  option.replace(option.find("OVERVIEW_LEVEL"), 14, "JPEG_QUALITY");
  EXPECT_THAT(said(vrt(option)), HasSubstr("may not open its sources with JPEG_QUALITY"));
  std::string crs = vrt(source("a.tif"));
  crs.replace(crs.find("EPSG:32616"), 10, address() + "/crs");
  EXPECT_THAT(said(crs), HasSubstr("must be an authority's code"));
}

TEST_F(OutsideAccess, OfAVirtualRasterIsFollowedThroughOthersAndLinks) {
  testing::write_text(data("inner.vrt"), vrt(source("../secret.tif")));
  EXPECT_THAT(said(vrt(source("inner.vrt"))), HasSubstr("is made of: "));
  EXPECT_THAT(said(vrt(source("inner.vrt"))), HasSubstr("not named relative to it"));
  testing::write_text(data("inner.vrt"), vrt(source("a.tif")));
  EXPECT_EQ(said(vrt(source("inner.vrt"))), "ok");
  fs::create_symlink(data("inner.vrt"), data("link.vrt"));
  EXPECT_THAT(said(vrt(source("link.vrt"))), HasSubstr("is a symbolic link: link.vrt"));
  fs::create_symlink(root() / "secret.tif", data("link.tif"));
  EXPECT_THAT(said(vrt(source("link.tif"))), HasSubstr("not named relative to it"));
  EXPECT_NE(said(vrt(source("all.vrt"))), "ok") << "made of itself";
  ASSERT_EQ(::mkfifo(data("fifo").c_str(), 0600), 0);
  EXPECT_NE(said(vrt(source("fifo"))), "ok");
  std::string deep;
  for (int i = 0; i < 500; ++i) deep += "<Metadata>";
  EXPECT_NE(said(vrt(deep)), "ok");
}

TEST_F(OutsideAccess, OfOverviewsIsTheFilesOwnFolder) {
  const auto with_overviews = [&](const std::string& name) {
    testing::write_text(data("a.tif.aux.xml"),
                        "<PAMDataset><Metadata domain=\"OVERVIEWS\"><MDI key=\"OVERVIEW_FILE\">" +
                            name + "</MDI></Metadata></PAMDataset>");
    const auto opened = open_raster(data("a.tif"));
    return opened ? "ok" : opened.error().message;
  };
  EXPECT_EQ(with_overviews(":::BASE:::a.ovr"), "ok");
  EXPECT_THAT(with_overviews((root() / "secret.tif").string()), HasSubstr("names overviews"));
  EXPECT_THAT(with_overviews(":::BASE:::../secret.tif"), HasSubstr("names overviews"));
  EXPECT_THAT(with_overviews("/vsicurl/" + address() + "/a.ovr"), HasSubstr("names overviews"));
}

TEST_F(OutsideAccess, OfOverviewsThatAreAVirtualRasterIsTheirFolder) {
  RasterFile dark;
  dark.value = [](int, int, int) { return 7.0; };
  testing::write_raster(data("a.tif"), dark);
  RasterFile bright = dark;
  bright.value = [](int, int, int) { return 99.0; };
  testing::write_raster(root() / "secret.tif", bright);
  testing::write_raster(data("own.tif"), bright);
  // The grey value of the first overview; -1 = there is none.
  const auto seen = [&](const std::string& name, bool relative) {
    std::string overview = vrt(source(name, relative));
    for (std::size_t at = 0; (at = overview.find("Size=\"64\"", at)) != std::string::npos;) {
      overview.replace(at, 9, "Size=\"32\"");
    }
    testing::write_text(data("a.tif.ovr"), overview);
    const auto opened = open_raster(data("a.tif"));
    GDALRasterBand* band = (*opened)->GetRasterBand(1);
    if (band->GetOverviewCount() == 0) return -1;
    std::uint8_t grey = 0;
    EXPECT_EQ(
        band->GetOverview(0)->RasterIO(GF_Read, 0, 0, 1, 1, &grey, 1, 1, GDT_Byte, 0, 0, nullptr),
        CE_None);
    return static_cast<int>(grey);
  };
  EXPECT_EQ(seen("own.tif", true), 99);
  EXPECT_EQ(seen((root() / "secret.tif").string(), false), -1);
  EXPECT_EQ(seen("../secret.tif", true), -1);
}

/// Replaces a name inside a file by one of equal length.
void rename_inside(const fs::path& file, const std::string& from, const std::string& to) {
  std::string bytes = testing::read_text(file);
  const std::size_t at = bytes.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  ASSERT_EQ(from.size(), to.size());
  bytes.replace(at, to.size(), to);
  testing::write_text(file, bytes);
}

TEST_F(OutsideAccess, OfAnErdasRasterAreFilesWithItsName) {
  initialise_gdal();
  RasterFile raster;
  raster.driver = "HFA";
  raster.options = {"USE_SPILL=YES"};
  testing::write_raster(data("largest.img"), raster);
  ASSERT_TRUE(fs::exists(data("largest.ige")));
  {
    const CPLConfigOptionSetter in_rrd("HFA_USE_RRD", "YES", false);
    const GDALDatasetUniquePtr dataset(
        GDALDataset::Open(data("largest.img").c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE));
    ASSERT_NE(dataset, nullptr);
    int factor = 2;
    ASSERT_EQ(dataset->BuildOverviews("AVERAGE", 1, &factor, 0, nullptr, nullptr, nullptr),
              CE_None);
  }
  ASSERT_TRUE(fs::exists(data("largest.rrd")));
  const auto opening = [&] {
    const auto opened = open_raster(data("largest.img"));
    return opened ? "ok" : opened.error().message;
  };
  EXPECT_EQ(opening(), "ok");
  const std::string whole = testing::read_text(data("largest.img"));

  fs::copy_file(data("largest.ige"), root() / "oute.ige");
  fs::copy_file(data("largest.ige"), data("another.ige"));
  fs::copy_file(data("largest.rrd"), data("another.rrd"));
  for (const std::string name : {"../oute.ige", "another.ige", "another.rrd"}) {
    rename_inside(data("largest.img"), "largest" + name.substr(7), name);
    EXPECT_THAT(opening(), HasSubstr("consists of a file that is not next to it")) << name;
    EXPECT_NE(said(vrt(source("largest.img"))), "ok") << name;
    testing::write_text(data("largest.img"), whole);
  }
}

TEST_F(OutsideAccess, OfACoordinateReferenceSystemIsNone) {
  RasterFile bare;
  bare.crs = "";
  testing::write_raster(data("bare.tif"), bare);
  for (const std::string& crs : {address() + "/crs", "/vsicurl/" + address() + "/crs"}) {
    WorldSpec spec;
    spec.imagery.push_back({data("bare.tif"), "", crs});
    spec.ground_height_m = 200.0;
    const auto world = open_world(spec);
    ASSERT_FALSE(world.ok());
    EXPECT_THAT(world.error().message, HasSubstr("must be an authority's code"));
  }
}

TEST_F(OutsideAccess, OfAFifoOrADeviceIsRefusedAndNotWaitedFor) {
  ASSERT_EQ(::mkfifo(data("fifo").c_str(), 0600), 0);
  for (const fs::path& file : {data("fifo"), fs::path("/dev/zero"), root()}) {
    const auto opened = open_raster(file);
    ASSERT_FALSE(opened.ok());
    EXPECT_EQ(opened.error().code, ErrorCode::kUnreadable) << file;
  }
  const auto manifest = read_world_manifest("/proc/self/mem");
  ASSERT_FALSE(manifest.ok());
  EXPECT_EQ(manifest.error().code, ErrorCode::kIo);
}

TEST_F(OutsideAccess, ThroughTheNetworkIsTurnedOffForGood) {
  ::setenv("PROJ_NETWORK", "ON", 1);
  turn_network_off();
  PJ_CONTEXT* context = proj_context_create();
  EXPECT_EQ(proj_context_is_network_enabled(context), 0);
  proj_context_destroy(context);
  EXPECT_EQ(OSRGetPROJEnableNetwork(), 0);
  const GdalMessages messages;
  CPLHTTPResult* reply = CPLHTTPFetch((address() + "/a").c_str(), nullptr);
  ASSERT_NE(reply, nullptr);
  EXPECT_EQ(reply->nDataLen, 0);
  EXPECT_STREQ(reply->pszErrBuf, "network access is disabled in this program");
  CPLHTTPDestroyResult(reply);
  CPLHTTPSetFetchCallback(nullptr, nullptr);  // other tests of this program download
}

TEST_F(OutsideAccess, OfAConfinedManifestIsItsDataFolders) {
  const auto manifest_of = [&](const std::string& file) {
    testing::write_text(data("world.json"),
                        R"({"format_version": 1, "ground_height_m": 200, "imagery": [{"file": ")" +
                            file + R"("}]})");
    const auto spec = read_world_manifest(data("world.json"), SourcePolicy::inside({data("")}));
    if (!spec) return spec.error().message;
    const auto world = open_world(*spec);
    return world ? std::string("ok") : world.error().message;
  };
  EXPECT_EQ(manifest_of("a.tif"), "ok");
  EXPECT_EQ(manifest_of("none.tif"),
            "imagery.0.file = " + data("none.tif").string() + ": no such file");
  const std::string outside = ": must be a file inside of the server's data folders";
  for (const std::string& file :
       {(root() / "secret.tif").string(), (root() / "none.tif").string()}) {
    EXPECT_EQ(manifest_of(file), "imagery.0.file = " + file + outside);
    EXPECT_EQ(manifest_of("../" + fs::path(file).filename().string()),
              "imagery.0.file = " + file + outside);
  }
  const auto elsewhere =
      read_world_manifest(root() / "world.json", SourcePolicy::inside({data("")}));
  EXPECT_EQ(elsewhere.error().message,
            "world.manifest = " + (root() / "world.json").string() + outside);
}

TEST_F(OutsideAccess, ToAWorldEndsWhenItsOpeningIsCancelled) {
  WorldSpec spec;
  spec.imagery.push_back({data("a.tif"), "", {}});
  RasterFile heights;
  heights.type = "Float32";
  testing::write_raster(data("h.tif"), heights);
  ElevationLayer layer;
  layer.file = data("h.tif");
  layer.datum = VerticalDatum::kEllipsoid;
  spec.elevation.push_back(layer);
  int asked = 0;
  ASSERT_TRUE(open_world(spec, [&] {
                ++asked;
                return false;
              }).ok());
  EXPECT_GE(asked, 4);
  for (int after = 0; after < asked; ++after) {
    int count = 0;
    const auto world = open_world(spec, [&] { return count++ >= after; });
    ASSERT_FALSE(world.ok()) << after;
    EXPECT_EQ(world.error().code, ErrorCode::kCancelled) << after;
  }
}

}  // namespace
}  // namespace overfly::terrain
