#include <gtest/gtest.h>

#include "terrain/synthesize_strip.hpp"
#include "terrain/world.hpp"
#include "tests/support/support.hpp"

namespace overfly::terrain {
namespace {

using testing::TemporaryFolder;

StripOptions small_strip() {
  StripOptions options;
  options.length_m = 8e3;
  options.width_m = 1e3;
  options.texel_m = 1.0;
  options.post_m = 20.0;
  return options;
}

TEST(SynthesizeStrip, OpensAsAWorldOfTheSizeAskedFor) {
  TemporaryFolder folder;
  const auto target = folder.path() / "strip";
  ASSERT_TRUE(synthesize_strip(target, small_strip()));
  const auto spec = read_world_manifest(target / "world.json");
  ASSERT_TRUE(spec) << spec.error().message;
  const auto world = open_world(*spec);
  ASSERT_TRUE(world) << world.error().message;
  EXPECT_TRUE(world->warnings.empty()) << world->warnings.front();
  const TileGrid& grid = world->tiles->grid();
  EXPECT_DOUBLE_EQ(grid.texel_m, 1.0);
  EXPECT_NEAR(grid.width_m, 8192.0, 1e-6);
  EXPECT_NEAR(grid.height_m, 1024.0, 1e-6);
  const Eigen::Vector2d range_m = world->tiles->height_range_m();
  EXPECT_GT(range_m.y() - range_m.x(), 20.0);
  EXPECT_LT(range_m.y() - range_m.x(), 100.0);

  // The landscape's mirror image follows without a seam: its last column comes twice.
  constexpr int kSwatchPx = 1024;
  const auto west = world->tiles->tile({0, kSwatchPx / kTileTexels - 1, 0});
  ASSERT_TRUE(west) << west.error().message;
  int difference = 0;
  for (int y = 0; y < west->rgb.height_px; ++y) {
    const int last = kTileBorder + kTileTexels - 1;
    difference = std::max(difference, std::abs(west->rgb.at(last, y) - west->rgb.at(last + 1, y)));
  }
  // What JPEG adds to equal texels in neighbouring blocks.
  EXPECT_LT(difference, 40);

  // Every coarser level is the average of the one before, from the file's own overviews.
  for (int level = 1; level < grid.levels; ++level) {
    const auto fine = world->tiles->tile({level - 1, 0, 0});
    const auto coarse = world->tiles->tile({level, 0, 0});
    ASSERT_TRUE(fine && coarse);
    double sum = 0.0;
    int count = 0;
    for (int v = 0; v < 100; ++v) {
      for (int u = 0; u < 100; ++u) {
        const int x = kTileBorder + 2 * u;
        const int y = kTileBorder + 2 * v;
        if (coarse->valid.at(kTileBorder + u, kTileBorder + v) == 0) continue;
        const double mean = 0.25 * (fine->rgb.at(x, y, 1) + fine->rgb.at(x + 1, y, 1) +
                                    fine->rgb.at(x, y + 1, 1) + fine->rgb.at(x + 1, y + 1, 1));
        sum += std::abs(mean - coarse->rgb.at(kTileBorder + u, kTileBorder + v, 1));
        ++count;
      }
    }
    ASSERT_GT(count, 0);
    EXPECT_LT(sum / count, 4.0) << "level " << level;  // JPEG at quality 90
  }
}

TEST(SynthesizeStrip, RefusesWhatItCannotMakeAndCleansUpWhenCancelled) {
  TemporaryFolder folder;
  StripOptions options = small_strip();
  options.length_m = 1.0;
  const Status small = synthesize_strip(folder.path() / "a", options);
  ASSERT_FALSE(small);
  EXPECT_NE(small.error().message.find("length_m"), std::string::npos) << small.error().message;
  const Status stopped =
      synthesize_strip(folder.path() / "b", small_strip(), [](double) { return false; });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace overfly::terrain
