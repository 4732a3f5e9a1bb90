// Worlds that stay open between runs, and files that change meanwhile.
#include "server/worlds/world_cache.hpp"
#include "server/record/run_info.hpp"
#include "server/run/run_options.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>

#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"
#include "tests/server/support/server_fixture.hpp"
#include "tests/support/synthetic_world.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using overfly::testing::read_text;
using overfly::testing::TemporaryFolder;
using overfly::testing::write_text;
using ::testing::HasSubstr;

constexpr double kLeftM = 583000.0;
constexpr double kTopM = 4357000.0;
constexpr double kPostM = 10.0;
constexpr int kPosts = 121;

class WorldCacheTest : public ::testing::Test {
 protected:
  WorldCacheTest() { write_world(200.0); }

  [[nodiscard]] fs::path manifest() const { return folder_.path() / "world.json"; }
  [[nodiscard]] fs::path elevation() const { return folder_.path() / "elevation.tif"; }

  /// Flat ground; the file's size does not depend on the height.
  void write_world(double ground_m) {
    overfly::testing::GeoTiff imagery;
    imagery.image = overfly::testing::textured_image(300, 300, 3);
    imagery.left = kLeftM;
    imagery.top = kTopM;
    imagery.pixel = 2.0;
    write_geotiff(folder_.path() / "imagery.tif", imagery);
    ImageBuffer<float> heights(kPosts, kPosts, 1);
    std::fill(heights.data.begin(), heights.data.end(), static_cast<float>(ground_m));
    overfly::testing::write_elevation(
        elevation(), heights, "EPSG:32616", kLeftM - 300.0, kTopM + 300.0, kPostM);
    write_manifest("elevation.tif");
  }
  void write_manifest(const std::string& elevation_file) {
    terrain::WorldSpec spec;
    spec.name = "changing";
    spec.imagery.push_back({folder_.path() / "imagery.tif", "made for this test", {}});
    terrain::ElevationLayer layer;
    layer.file = folder_.path() / elevation_file;
    layer.datum = terrain::VerticalDatum::kEllipsoid;
    spec.elevation.push_back(layer);
    const Status written = terrain::write_world_manifest(manifest(), spec);
    if (!written) throw std::runtime_error(written.error().message);
  }
  void edit_manifest(const std::string& attribution) {
    Json json = Json::parse(read_text(manifest()));
    json["imagery"][0]["attribution"] = attribution;
    write_text(manifest(), json.dump());
  }
  [[nodiscard]] Scenario scenario() const {
    return testing::small_scenario({"world.manifest=" + manifest().string(), "duration_s=1"});
  }
  WorldCache::Shared world() {
    auto world = worlds_.get(scenario(), {});
    if (!world) throw std::runtime_error(world.error().message);
    return *world;
  }
  /// The world in the run's manifest.
  Json flown(const std::string& name, const std::function<void()>& meanwhile = {}) {
    RunOptions options;
    options.folder = folder_.path() / name;
    options.renderer_factory = testing::noop_factory();
    options.worlds = &worlds_;
    options.progress = [&](const RunInfo& info) {
      if (meanwhile && info.frames == 5) meanwhile();
    };
    const auto run = run_scenario(scenario(), options);
    EXPECT_TRUE(run.ok()) << run.error().message;
    return read_json(manifest_file(options.folder)).value().at("world");
  }

  TemporaryFolder folder_;
  WorldCache worlds_;
};

TEST_F(WorldCacheTest, KeepsAWorldWhoseFilesStayAsTheyAre) { EXPECT_EQ(world(), world()); }

TEST_F(WorldCacheTest, OpensAnEditedManifestAnew) {
  const auto before = world();
  edit_manifest("another credit");
  const auto after = world();
  EXPECT_NE(after, before);
  EXPECT_THAT(after->world.tiles->attribution(), HasSubstr("another credit"));
  EXPECT_NE(after->manifest->digest, before->manifest->digest);
  EXPECT_EQ(world(), after);
}

TEST_F(WorldCacheTest, OpensReplacedElevationAnew) {
  const auto before = world();
  write_world(250.0);
  const auto after = world();
  EXPECT_NEAR(before->world.tiles->height_range_m().x(), 200.0, 1e-3);
  EXPECT_NEAR(after->world.tiles->height_range_m().x(), 250.0, 1e-3);
  EXPECT_NE(after->world.data_hashes, before->world.data_hashes);
}

TEST_F(WorldCacheTest, NoticesBytesChangedBehindAnEqualSizeAndTime) {
  struct stat then {};
  ASSERT_EQ(::stat(elevation().c_str(), &then), 0);
  const auto before = world();
  std::string bytes = read_text(elevation());
  bytes[bytes.size() - 3] ^= 1;
  write_text(elevation(), bytes);
  const timespec times[2] = {then.st_atim, then.st_mtim};
  ASSERT_EQ(::utimensat(AT_FDCWD, elevation().c_str(), times, 0), 0);
  EXPECT_NE(world()->world.data_hashes, before->world.data_hashes);
}

TEST_F(WorldCacheTest, NoticesTheSourceOfAVirtualRaster) {
  write_text(folder_.path() / "all.vrt",
             R"(<VRTDataset rasterXSize="121" rasterYSize="121"><SRS>EPSG:32616</SRS>
<GeoTransform>582700, 10, 0, 4357300, 0, -10</GeoTransform>
<VRTRasterBand dataType="Float32" band="1"><SimpleSource>
<SourceFilename relativeToVRT="1">elevation.tif</SourceFilename><SourceBand>1</SourceBand>
</SimpleSource></VRTRasterBand></VRTDataset>)");
  write_manifest("all.vrt");
  const auto before = world();
  EXPECT_EQ(world(), before);
  EXPECT_NEAR(before->world.tiles->height_range_m().x(), 200.0, 1e-3);
  write_world(250.0);
  write_manifest("all.vrt");
  EXPECT_NEAR(world()->world.tiles->height_range_m().x(), 250.0, 1e-3);
}

TEST_F(WorldCacheTest, DropsAWorldThatCouldNotBeRead) {
  const auto hurt = world();
  const std::string whole = read_text(elevation());
  fs::resize_file(elevation(), 4000);
  const terrain::TileGrid& grid = hurt->world.tiles->grid();
  for (int i = 0; i <= 40; ++i) {
    (void)hurt->world.tiles->world_from_map(grid.left_x_m + 20.0 * i, grid.top_y_m - 20.0 * i);
  }
  ASSERT_FALSE(hurt->world.tiles->status().ok());
  EXPECT_EQ(hurt->world.tiles->status().error().code, ErrorCode::kIo);
  write_text(elevation(), whole);
  EXPECT_TRUE(world()->world.tiles->status().ok());
}

TEST_F(WorldCacheTest, ARunRecordsTheFilesThatItFlewOver) {
  const Json first = flown("first");
  EXPECT_EQ(first.at("manifest").at("file"), manifest().string());
  EXPECT_EQ(flown("again"), first);
  write_world(250.0);
  edit_manifest("another credit");
  const Json other = flown("other");
  EXPECT_NE(other.at("data_hashes"), first.at("data_hashes"));
  EXPECT_NE(other.at("manifest").at("digest"), first.at("manifest").at("digest"));
  EXPECT_THAT(other.at("attribution").get<std::string>(), HasSubstr("another credit"));
}

TEST_F(WorldCacheTest, ARunInFlightKeepsItsWorldBesideTheNewOne) {
  const Json before = flown("before");
  Json inner;
  const Json outer = flown("outer", [&] {
    fs::remove(elevation());
    write_world(250.0);
    inner = flown("inner");
  });
  EXPECT_EQ(outer, before);
  EXPECT_NE(inner.at("data_hashes"), before.at("data_hashes"));
}

}  // namespace
}  // namespace overfly::server
