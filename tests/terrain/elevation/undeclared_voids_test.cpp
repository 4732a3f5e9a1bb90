// Values that mean "no data" though nothing declares it, and ground that only looks like them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "terrain/build_world.hpp"
#include "terrain/elevation/steep_steps.hpp"
#include "terrain/elevation/void_plateaus.hpp"
#include "terrain/world.hpp"
#include "tests/support/support.hpp"
#include "tests/terrain/raster_file.hpp"

namespace overfly::terrain {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::RasterFile;
using testing::TemporaryFolder;

constexpr int kSide = 100;
constexpr double kSpacingM = 30.0;

/// Hills between 270 and 330 m.
double hills_m(int x, int y) {
  return 300.0 + 15.0 * std::sin(0.2 * x) + 15.0 * std::cos(0.17 * y);
}

bool in_hole(int x, int y) { return x >= 40 && x < 55 && y >= 45 && y < 53; }
constexpr int kHolePosts = 15 * 8;

class UndeclaredVoids : public ::testing::Test {
 protected:
  /// A small picture over the middle of 3 km x 3 km of heights.
  [[nodiscard]] WorldSpec spec_over(const std::function<double(int x, int y)>& height,
                                    const std::string& type = "Float32",
                                    std::optional<double> unit_m = {}) const {
    RasterFile picture;
    picture.transform = {{583000.0, 2.0, 0.0, 4357000.0, 0.0, -2.0}};
    testing::write_raster(folder_.path() / "picture.tif", picture);
    RasterFile heights;
    heights.type = type;
    heights.width_px = kSide;
    heights.height_px = kSide;
    heights.transform = {{581600.0, kSpacingM, 0.0, 4358400.0, 0.0, -kSpacingM}};
    heights.value = [&](int x, int y, int) { return height(x, y); };
    testing::write_raster(folder_.path() / "heights.tif", heights);
    WorldSpec spec;
    spec.imagery.emplace_back().file = folder_.path() / "picture.tif";
    spec.elevation.emplace_back().file = folder_.path() / "heights.tif";
    spec.elevation.back().datum = VerticalDatum::kEllipsoid;
    spec.elevation.back().unit_m = unit_m;
    return spec;
  }
  [[nodiscard]] static World opened(const WorldSpec& spec) {
    auto world = open_world(spec);
    EXPECT_TRUE(world) << (world ? "" : world.error().message);
    return world ? *world : World{};
  }

  TemporaryFolder folder_;
};

TEST_F(UndeclaredVoids, HolesOfTheUsualValuesAreMissingWithAWarningThatCountsThem) {
  for (const double value : {-9999.0, -10000.0, 0.0, -32768.0, -32767.0}) {
    const World world = opened(
        spec_over([&](int x, int y) { return in_hole(x, y) ? value : hills_m(x, y); }, "Float32"));
    SCOPED_TRACE(value);
    if (value > -12000.0) {
      EXPECT_THAT(
          world.warnings,
          Contains(AllOf(HasSubstr("heights.tif: 120 of 10000 posts (1.2 %) have a usual value of "
                                   "missing data (" +
                                   std::to_string(static_cast<int>(value)) + ")"),
                         HasSubstr("treated as missing"))));
    } else {
      EXPECT_THAT(world.warnings, Contains(HasSubstr("120 heights outside -12000 to 9000 m")));
    }
    EXPECT_THAT(world.warnings, Contains(HasSubstr("120 of 10000 posts (1.2 %) have no data")));
    EXPECT_THAT(world.warnings, Not(Contains(HasSubstr("neighbouring posts differ"))));
    EXPECT_GT(world.tiles->height_range_m().x(), 265.0);
    EXPECT_LT(world.tiles->height_range_m().y(), 335.0);
  }
}

TEST_F(UndeclaredVoids, AlsoSinglePostsAndHolesAtTheEdge) {
  const World world = opened(spec_over([](int x, int y) {
    if (x == 50 && y == 50) return -9999.0;
    if (x < 3 || y > 95) return -10000.0;
    return x > 97 && y < 10 ? 0.0 : hills_m(x, y);
  }));
  EXPECT_THAT(world.warnings, Contains(HasSubstr("missing data (-10000, -9999, 0)")));
  EXPECT_GT(world.tiles->height_range_m().x(), 265.0);
}

/// Below it are depths and heights in another unit: only jumps distinguish them.
TEST_F(UndeclaredVoids, ValuesOfOtherUnitsAreSeenToo) {
  // 16-bit centimetres end at -327.68 m, 32-bit decimetres may have 999.9 m.
  const World centimetres = opened(
      spec_over([](int x, int y) { return in_hole(x, y) ? -32768.0 : 100.0 * hills_m(x, y) / 2.0; },
                "Int16",
                0.01));
  EXPECT_THAT(centimetres.warnings, Contains(HasSubstr("120 of 10000 posts (1.2 %) have a usual")));
  EXPECT_GT(centimetres.tiles->height_range_m().x(), 130.0);
  const World decimetres = opened(spec_over(
      [](int x, int y) { return in_hole(x, y) ? 9999.0 : 10.0 * hills_m(x, y); }, "Int32", 0.1));
  EXPECT_THAT(decimetres.warnings, Contains(HasSubstr("missing data (9999)")));
  EXPECT_LT(decimetres.tiles->height_range_m().y(), 335.0);
}

TEST_F(UndeclaredVoids, GroundThatHasTheseHeightsStaysAsItIs) {
  const struct {
    const char* what;
    std::function<double(int x, int y)> height;
    double low_m;
    double high_m;
  } grounds[] = {
      {"a sea next to cliffs of 20 m", [](int x, int) { return x < 50 ? 0.0 : 20.0; }, 0.0, 20.0},
      {"a sea next to cliffs of 200 m with one beach",
       [](int x, int y) { return x < 50               ? 0.0
                                 : x == 50 && y == 30 ? 2.0
                                                      : 200.0; },
       0.0,
       200.0},
      {"only sea", [](int, int) { return 0.0; }, 0.0, 0.0},
      {"a slope into the Dead Sea, in whole metres",
       [](int x, int) { return -432.0 + 6.0 * x; },
       -432.0,
       162.0},
      {"a trench, in whole metres",
       [](int x, int y) {
         return -9980.0 - std::round(40.0 * std::sin(0.1 * x) * std::cos(0.1 * y));
       },
       -10020.0,
       -9940.0},
      {"a lake with an island as steep as a tower of 40 m",
       [](int x, int y) { return in_hole(x, y) ? 40.0 : 0.0; },
       0.0,
       40.0},
  };
  for (const auto& ground : grounds) {
    const World world = opened(spec_over(ground.height));
    EXPECT_THAT(world.warnings, IsEmpty()) << ground.what;
    EXPECT_NEAR(world.tiles->height_range_m().x(), ground.low_m, 1.0) << ground.what;
    EXPECT_NEAR(world.tiles->height_range_m().y(), ground.high_m, 1.0) << ground.what;
  }
}

/// Both in one file: each plateau is judged by itself.
TEST_F(UndeclaredVoids, AHoleInlandIsFoundBesideASea) {
  const World world = opened(spec_over([](int x, int y) {
    if (in_hole(x, y)) return 0.0;
    return std::max(0.0, 12.0 * (x - 15));
  }));
  EXPECT_THAT(world.warnings, Contains(HasSubstr("120 of 10000 posts")));
  EXPECT_EQ(world.tiles->height_range_m().x(), 0.0);
  EXPECT_GT(world.spec.origin->alt_ellipsoid_m, 300.0);  // which lies in the hole
}

TEST_F(UndeclaredVoids, NothingButAVoidValueIsAnErrorThatSaysSo) {
  const auto world = open_world(spec_over([](int, int) { return -9999.0; }));
  ASSERT_FALSE(world);
  EXPECT_THAT(world.error().message,
              AllOf(HasSubstr("no heights near the imagery"), HasSubstr("(-9999)")));
}

TEST_F(UndeclaredVoids, StepsThatNoGroundMakesAreWarnedOf) {
  const World world =
      opened(spec_over([](int x, int y) { return x == 50 && y == 50 ? 5000.0 : hills_m(x, y); }));
  EXPECT_THAT(world.warnings,
              ElementsAre(AllOf(HasSubstr("heights.tif: 4 neighbouring posts differ by more than "
                                          "1000 m, up to 47"),
                                HasSubstr("\"nodata\""))));
}

TEST_F(UndeclaredVoids, TheManifestsWordIsTheLast) {
  WorldSpec spec = spec_over([](int x, int y) { return in_hole(x, y) ? -9999.0 : hills_m(x, y); });
  spec.elevation.back().nodata = -1.0;
  const World kept = opened(spec);
  EXPECT_EQ(kept.tiles->height_range_m().x(), -9999.0);
  EXPECT_THAT(kept.warnings, ElementsAre(HasSubstr("neighbouring posts differ")));
  spec.elevation.back().nodata = -9999.0;
  EXPECT_THAT(opened(spec).warnings, ElementsAre(HasSubstr("have no data and are filled")));
}

TEST_F(UndeclaredVoids, MergedLayersAndBuiltWorldsLeaveThemOutAsWell) {
  WorldSpec spec = spec_over([](int x, int y) { return in_hole(x, y) ? -9999.0 : hills_m(x, y); });
  RasterFile below;
  below.type = "Int16";
  below.transform = {{580000.0, 100.0, 0.0, 4360000.0, 0.0, -100.0}};
  below.value = [](int, int, int) { return 250.0; };
  testing::write_raster(folder_.path() / "below.tif", below);
  spec.elevation.push_back(spec.elevation.front());
  spec.elevation.back().file = folder_.path() / "below.tif";
  spec.cache_folder = folder_.path() / "world.cache";
  const auto built = build_world(spec);
  ASSERT_TRUE(built) << built.error().message;
  const World world = opened(spec);
  EXPECT_THAT(world.cache, HasSubstr("in use"));
  EXPECT_EQ(world.warnings, built->warnings);
  EXPECT_THAT(world.warnings, Contains(HasSubstr("heights.tif: 120 of ")));
  // The second layer fills the hole.
  EXPECT_NEAR(world.tiles->height_range_m().x(), 250.0, 1e-3);
}

/// Feeds a raster of numbers that are metres.
VoidRuns voids_of(int columns, int rows, const std::function<float(int x, int y)>& value) {
  VoidPlateaus plateaus(columns, kSpacingM);
  std::vector<float> row(static_cast<std::size_t>(columns));
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) row[static_cast<std::size_t>(x)] = value(x, y);
    plateaus.add_row(row.data(), row.data());
  }
  return plateaus.finish();
}

TEST(VoidPlateaus, ArmsThatMeetLaterAreOnePlateau) {
  // A U of zeros in ground at 300 m; with `beach` one post of 5 m next to its left arm.
  const auto u_shape = [](int x, int y, bool beach) {
    const bool arm = (x == 10 || x == 30) && y >= 5 && y <= 40;
    if (arm || (y == 40 && x >= 10 && x <= 30)) return 0.0F;
    return beach && x == 9 && y == 6 ? 5.0F : 300.0F;
  };
  EXPECT_EQ(voids_of(50, 50, [&](int x, int y) { return u_shape(x, y, false); }).posts,
            2 * 35 + 21);
  EXPECT_EQ(voids_of(50, 50, [&](int x, int y) { return u_shape(x, y, true); }).posts, 0);
}

/// A noisy sea has a plateau for every other post: memory must not grow with it.
TEST(VoidPlateaus, FindsAHoleAmongMillionsOfPlateausThatAreGround) {
  const VoidRuns found = voids_of(2000, 3000, [](int x, int y) {
    if (y == 2900 && x >= 700 && x < 710) return -9999.0F;
    return (x + y) % 2 == 0 ? 0.0F : 1.0F;
  });
  EXPECT_EQ(found.posts, 10);
  ASSERT_EQ(found.runs.size(), 1U);
  EXPECT_EQ(found.runs.front().row, 2900);
}

TEST(SteepSteps, AreCountedAcrossBlocks) {
  HeightGrid block{2, 2, {0.0F, 0.0F, 0.0F, 0.0F}};
  HeightGrid high{2, 2, {2000.0F, 2000.0F, 2000.0F, std::nanf("")}};
  SteepSteps steps(4, 1000.0);
  steps.add(0, block);
  steps.add(2, high);   // two steps to the west
  steps.add(0, high);   // two steps to the north
  steps.add(2, block);  // one step to the west, next to missing data, and one to the north
  EXPECT_EQ(steps.count(), 6.0);
  EXPECT_EQ(steps.largest_m(), 2000.0);
}

}  // namespace
}  // namespace overfly::terrain
