#include "terrain/synthesize.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "core/motion/pose.hpp"
#include "terrain/synthesis/landscape/painter.hpp"
#include "terrain/world.hpp"
#include "tests/support/support.hpp"

namespace overfly::terrain {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;

/// The smallest world, coarse enough to be made in a second.
SynthesisOptions small_world(std::uint64_t seed = 1) {
  SynthesisOptions options;
  options.seed = seed;
  options.size_m = 500.0;
  options.texel_m = 1.5;
  return options;
}

int entries(const fs::path& folder) {
  int count = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder)) ++count;
  return count;
}

Result<World> open_folder(const fs::path& folder) {
  const auto spec = read_world_manifest(folder / "world.json");
  if (!spec) return spec.error();
  return open_world(*spec);
}

TEST(SynthesizeWorld, GivesTheSameBytesForTheSameOptionsAndOthersForAnotherSeed) {
  TemporaryFolder folder;
  ASSERT_TRUE(synthesize_world(folder.path() / "a", small_world()));
  ASSERT_TRUE(synthesize_world(folder.path() / "b", small_world()));
  ASSERT_TRUE(synthesize_world(folder.path() / "c", small_world(2)));
  for (const char* file : {"imagery.tif", "elevation.tif", "world.json"}) {
    const std::string a = testing::read_text(folder.path() / "a" / file);
    EXPECT_EQ(a, testing::read_text(folder.path() / "b" / file)) << file;
    EXPECT_NE(a, testing::read_text(folder.path() / "c" / file)) << file;
  }
}

TEST(SynthesizeWorld, OpensLikeRealDataWithoutAWarning) {
  TemporaryFolder folder;
  const SynthesisOptions options = small_world();
  ASSERT_TRUE(synthesize_world(folder.path() / "w", options));
  const auto world = open_folder(folder.path() / "w");
  ASSERT_TRUE(world) << world.error().message;
  EXPECT_TRUE(world->warnings.empty()) << world->warnings.front();
  const TileGrid& grid = world->tiles->grid();
  EXPECT_GE(grid.width_m, options.size_m);
  EXPECT_DOUBLE_EQ(grid.texel_m, options.texel_m);
  EXPECT_EQ(world->tiles->coverage({0, 0, 0}),
            grid.cols > 1 ? TileCoverage::kFull : TileCoverage::kPartial);
  const Geodetic& origin = world->tiles->frame().origin();
  EXPECT_NEAR(deg_from_rad(origin.lat_rad), 39.35, 1e-4);
  EXPECT_NEAR(deg_from_rad(origin.lon_rad), -86.03, 1e-4);
  EXPECT_FALSE(world->tiles->attribution().empty());
}

TEST(SynthesizeWorld, HasALevelRunwayThatPointsSouthFromItsNorthEnd) {
  TemporaryFolder folder;
  SynthesisOptions options = small_world();
  options.relief_m = 60.0;
  ASSERT_TRUE(synthesize_world(folder.path() / "w", options));
  const auto world = open_folder(folder.path() / "w");
  ASSERT_TRUE(world) << world.error().message;
  ASSERT_TRUE(world->spec.runway);
  const WorldSpec::Runway& runway = *world->spec.runway;
  EXPECT_NEAR(deg_from_rad(runway.heading_rad), 180.0, 12.0);
  const Eigen::Vector3d start =
      world->tiles->frame().world_from_geodetic({runway.lat_rad, runway.lon_rad, 0.0});
  EXPECT_GT(start.y(), 60.0) << "the threshold is north of the middle";
  const double first_m = world->tiles->ground_up_m(start.x(), start.y());
  for (double along_m = 0.0; along_m < 140.0; along_m += 10.0) {
    const double east_m = start.x() + along_m * std::sin(runway.heading_rad);
    const double north_m = start.y() + along_m * std::cos(runway.heading_rad);
    EXPECT_NEAR(world->tiles->ground_up_m(east_m, north_m), first_m, 0.05) << along_m;
  }
  const Eigen::Vector2d range_m = world->tiles->height_range_m();
  EXPECT_GT(range_m.y() - range_m.x(), 0.4 * options.relief_m);
}

TEST(SynthesizeWorld, PaintsTheSameTexelsInAnyBlocks) {
  synthesis::LandscapeOptions options;
  options.half_m = 300.0F;
  options.reach_m = 50.0F;
  const synthesis::Landscape land = synthesis::Landscape::plan(options);
  const Image whole = synthesis::paint_block(land, 0.5F, 100, 130, 200, 160);
  for (int y = 0; y < 160; y += 80) {
    for (int x = 0; x < 200; x += 50) {
      const Image part = synthesis::paint_block(land, 0.5F, 100 + x, 130 + y, 50, 80);
      for (int v = 0; v < 80; ++v) {
        for (int u = 0; u < 50; ++u) {
          ASSERT_EQ(part.at(u, v, 1), whole.at(x + u, y + v, 1)) << x + u << ' ' << y + v;
        }
      }
    }
  }
}

TEST(SynthesizeWorld, ThatIsCancelledLeavesNothing) {
  TemporaryFolder folder;
  int calls = 0;
  const Status status = synthesize_world(folder.path() / "w", small_world(), [&](double share) {
    EXPECT_GE(share, 0.0);
    EXPECT_LE(share, 1.0);
    return ++calls < 2;
  });
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::kCancelled);
  EXPECT_EQ(entries(folder.path()), 0);
}

TEST(SynthesizeWorld, NeverOverwritesAFolder) {
  TemporaryFolder folder;
  testing::write_text(folder.path() / "mine.txt", "mine");
  const Status status = synthesize_world(folder.path(), small_world());
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().code, ErrorCode::kConflict);
  EXPECT_EQ(entries(folder.path()), 1);
}

TEST(SynthesizeWorld, ErrorsNameTheOptionTheValueAndTheLimit) {
  TemporaryFolder folder;
  const auto error_of = [&](auto change) {
    SynthesisOptions options = small_world();
    change(options);
    const Status status = synthesize_world(folder.path() / "w", options);
    return status ? std::string("no error") : status.error().message;
  };
  const auto expect = [](const std::string& message, const char* field, const char* limit) {
    EXPECT_NE(message.find(field), std::string::npos) << message;
    EXPECT_NE(message.find(limit), std::string::npos) << message;
  };
  expect(error_of([](auto& o) { o.size_m = 499; }), "size_m = 499", "[500, 10000]");
  expect(error_of([](auto& o) { o.size_m = std::nan(""); }), "size_m", "[500, 10000]");
  expect(error_of([](auto& o) { o.texel_m = 6; }), "texel_m = 6", "[0.1, 5]");
  expect(error_of([](auto& o) { o.relief_m = -1; }), "relief_m = -1", "[0, 400]");
  expect(error_of([](auto& o) { o.center_lat_rad = 1.5; }), "center_lat_deg = 85", "[-80, 80]");
  EXPECT_EQ(entries(folder.path()), 0);
}

TEST(EnsureWorld, AskedForTwiceAtOnceIsMadeOnce) {
  TemporaryFolder folder;
  const fs::path target = folder.path() / "cache" / "w";
  std::atomic<int> made{0};
  std::atomic<int> failed{0};
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i) {
    threads.emplace_back([&] {
      const Status there = ensure_world(target, small_world(), [&](double share) {
        if (share >= 1.0) ++made;
        return true;
      });
      if (!there) ++failed;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(failed, 0);
  EXPECT_EQ(made, 1);
  EXPECT_TRUE(open_folder(target));
}

}  // namespace
}  // namespace overfly::terrain
