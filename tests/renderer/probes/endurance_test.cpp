// Five kilometres over a strip of GeoTIFF: paging changes nothing in the images, and what is kept
// stays within its budget.
#include "renderer/probes/endurance.hpp"

#include <gtest/gtest.h>

#include "terrain/synthesize_strip.hpp"
#include "terrain/world.hpp"
#include "tests/renderer/procedural_ground.hpp"
#include "tests/support/support.hpp"

namespace overfly::renderer {
namespace {

EnduranceOptions small_flight(CameraBackend backend) {
  EnduranceOptions options;
  options.length_m = 5e3;
  options.rate_hz = 3.0;
  options.width_px = 320;
  options.height_px = 240;
  options.warm_up_s = 20.0;
  options.camera_backend = backend;
  return options;
}

/// The strip is made once for all tests.
class Endurance : public ::testing::TestWithParam<CameraBackend> {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<overfly::testing::TemporaryFolder>();
    terrain::StripOptions strip;
    strip.length_m = 6e3;
    strip.width_m = 1e3;
    const auto target = folder_->path() / "strip";
    const Status made = terrain::synthesize_strip(target, strip);
    ASSERT_TRUE(made.ok()) << made.error().message;
    const auto spec = terrain::read_world_manifest(target / "world.json");
    ASSERT_TRUE(spec.ok()) << spec.error().message;
    const auto world = terrain::open_world(*spec);
    ASSERT_TRUE(world.ok()) << world.error().message;
    tiles_ = world->tiles;
  }
  static void TearDownTestSuite() {
    tiles_.reset();
    folder_.reset();
  }
  void SetUp() override {
    if (GetParam() != CameraBackend::kEgl) return;
    if (const auto egl = probe_egl(); !egl.ok()) GTEST_SKIP() << egl.error().message;
  }

  static std::unique_ptr<overfly::testing::TemporaryFolder> folder_;
  static std::shared_ptr<const terrain::TileSource> tiles_;
};

std::unique_ptr<overfly::testing::TemporaryFolder> Endurance::folder_;
std::shared_ptr<const terrain::TileSource> Endurance::tiles_;

TEST_P(Endurance, FiveKilometresLookTheSameCrampedColdAndWarm) {
  EnduranceOptions options = small_flight(GetParam());
  options.tile_store = std::make_shared<TileStore>(tiles_, TileStoreOptions{});
  const auto cold = fly_endurance(tiles_, options);
  ASSERT_TRUE(cold.ok()) << cold.error().message;
  const std::int64_t read = cold->tiles.read_ahead + cold->tiles.read_on_demand;
  const auto warm = fly_endurance(tiles_, options);
  ASSERT_TRUE(warm.ok()) << warm.error().message;
  // Some six tiles of grey: less than a view needs with its coarser levels.
  options.tile_store = nullptr;
  options.tile_cache_bytes = std::size_t{2} << 20U;
  const auto cramped = fly_endurance(tiles_, options);
  ASSERT_TRUE(cramped.ok()) << cramped.error().message;

  EXPECT_EQ(cold->digest, warm->digest);
  EXPECT_EQ(cold->digest, cramped->digest);
  EXPECT_EQ(cold->late_tiles + warm->late_tiles + cramped->late_tiles, 0);
  // The second flight found its tiles in memory: what it reads, the first had no time to read
  // ahead.
  EXPECT_LE(warm->tiles.read_ahead + warm->tiles.read_on_demand, read + read / 5);
  // How many depends on how fast this machine draws: nothing holds a flight back here.
  EXPECT_GT(cold->tiles.read_ahead, 0);
  // The flight shows more than the small budget holds, and the process does not keep it: what
  // comes on top is the allocator's, GDAL's and the driver's.
  EXPECT_GT(cold->tiles_peak_bytes, 4 * options.tile_cache_bytes);
  EXPECT_LE(cramped->tiles_peak_bytes, options.tile_cache_bytes);
  EXPECT_GT(cramped->tiles.let_go, 20);
  const double after_warm_up_mb = cramped->resident_mb_by_tenth.front();
  EXPECT_GT(after_warm_up_mb, 0.0);
  EXPECT_LT(cramped->resident_peak_mb - after_warm_up_mb, 60.0);
}

INSTANTIATE_TEST_SUITE_P(Backends,
                         Endurance,
                         ::testing::Values(CameraBackend::kEgl, CameraBackend::kRaycast),
                         [](const auto& suite) {
                           return std::string(suite.param == CameraBackend::kEgl ? "egl"
                                                                                 : "raycast");
                         });

TEST(EnduranceOptions, RefusesAFlightBeyondTheImagery) {
  EnduranceOptions options = small_flight(CameraBackend::kRaycast);
  options.length_m = 50e3;
  const auto flown = fly_endurance(overfly::testing::natural_ground(), options);
  ASSERT_FALSE(flown.ok());
  EXPECT_EQ(flown.error().code, ErrorCode::kInvalidArgument);
  EXPECT_NE(flown.error().message.find("2048"), std::string::npos);
}

TEST(EnduranceOptions, RefusesAFlightShorterThanItsWarmUp) {
  EnduranceOptions options = small_flight(CameraBackend::kRaycast);
  options.length_m = 1e3;
  const auto flown = fly_endurance(overfly::testing::natural_ground(), options);
  ASSERT_FALSE(flown.ok());
  EXPECT_NE(flown.error().message.find("warm-up"), std::string::npos);
}

}  // namespace
}  // namespace overfly::renderer
