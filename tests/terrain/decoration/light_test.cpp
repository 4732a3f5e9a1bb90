// Shading against the cosine law, shadows against height / tan(elevation), tiles against each
// other.
#include "terrain/decoration/light.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/motion/pose.hpp"
#include "terrain/height_errors.hpp"
#include "terrain/world.hpp"
#include "terrain/world/drape.hpp"
#include "tests/support/support.hpp"
#include "tests/support/synthetic_world.hpp"
#include "tests/terrain/decoration/analytic_tiles.hpp"

namespace overfly::terrain {
namespace {

using testing::AnalyticTiles;

constexpr int kGrey = 100;

double linear_from_srgb(int value) {
  const double v = value / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

LightOptions sun_at(double azimuth_deg, double elevation_deg) {
  LightOptions options;
  options.sun_azimuth_rad = rad_from_deg(azimuth_deg);
  options.sun_elevation_rad = rad_from_deg(elevation_deg);
  return options;
}

std::shared_ptr<const TileSource> grey_ground(AnalyticTiles::Height height,
                                              Eigen::Vector2d range_m,
                                              double texel_m = 0.25,
                                              int tiles = 4) {
  return std::make_shared<AnalyticTiles>(
      texel_m, tiles, std::move(height), range_m, [](int, int) { return kGrey; });
}

Tile lit_tile(const std::shared_ptr<const TileSource>& tiles,
              const LightOptions& options,
              const TileId& id) {
  auto lit = with_light(tiles, options);
  if (!lit) throw std::runtime_error(lit.error().message);
  auto tile = (*lit)->tile(id);
  if (!tile) throw std::runtime_error(tile.error().message);
  return std::move(*tile);
}

/// Light at a texel of level 0, by its place from the tile's corner.
double light_at(const Tile& tile, int x, int y) {
  return linear_from_srgb(tile.rgb.at(kTileBorder + x, kTileBorder + y)) / linear_from_srgb(kGrey);
}

TEST(Light, FromHeightsThatCouldNotBeReadIsNotKept) {
  bool damaged = true;
  const auto ground = grey_ground(
      [&](double east, double) {
        if (damaged) HeightErrors::add({ErrorCode::kIo, "a damaged block"});
        return damaged ? 0.0 : 0.3 * east;
      },
      {-300.0, 300.0});
  const LightOptions options = sun_at(90.0, 40.0);
  const auto lit = with_light(ground, options).value();
  const auto dark = lit->tile({0, 1, 1});
  ASSERT_FALSE(dark);
  EXPECT_EQ(dark.error().message, "a damaged block");
  damaged = false;
  const auto tile = lit->tile({0, 1, 1});
  ASSERT_TRUE(tile) << tile.error().message;
  EXPECT_EQ(tile->rgb.data, lit_tile(ground, options, {0, 1, 1}).rgb.data);
}

TEST(Light, FollowsTheCosineLawOnARamp) {
  // The ground rises to the east by `slope`; the sun stands in the west or the east.
  for (const double slope_deg : {-20.0, 0.0, 10.0, 35.0}) {
    for (const double azimuth_deg : {90.0, 270.0}) {
      LightOptions options = sun_at(azimuth_deg, 40.0);
      options.cast_shadows = 0.0;
      const double rise = std::tan(rad_from_deg(slope_deg));
      const auto ground =
          grey_ground([&](double east, double) { return rise * east; }, {-300.0, 300.0});
      const double towards = azimuth_deg == 90.0 ? -slope_deg : slope_deg;
      const double cosine = std::sin(rad_from_deg(40.0 + towards));
      const double expected =
          std::min(3.0,
                   options.ambient + (1.0 - options.ambient) * std::max(0.0, cosine) /
                                         std::sin(rad_from_deg(40.0)));
      const Tile tile = lit_tile(ground, options, {0, 1, 1});
      // One grey level in 100 is 2.2 % of the light.
      EXPECT_NEAR(light_at(tile, 200, 300), expected, 0.015 * expected + 0.005)
          << slope_deg << " deg, sun at " << azimuth_deg;
    }
  }
}

TEST(Light, HalfTheStrengthGivesHalfTheShading) {
  LightOptions options = sun_at(270.0, 40.0);
  const Eigen::Vector3d normal =
      Eigen::Vector3d(-std::tan(rad_from_deg(20.0)), 0.0, 1.0).normalized();
  const double whole = slope_light(options, normal) - 1.0;
  options.hill_shading = 0.5;
  EXPECT_NEAR(slope_light(options, normal) - 1.0, 0.5 * whole, 1e-12);
  EXPECT_GT(whole, 0.1);
}

TEST(Light, LeavesFlatGroundAsItIs) {
  const auto flat = grey_ground([](double, double) { return 50.0; }, {50.0, 50.0});
  const Tile tile = lit_tile(flat, sun_at(123.0, 20.0), {0, 1, 2});
  for (const std::uint8_t value : tile.rgb.data) ASSERT_EQ(value, kGrey);
}

/// A wall 30 m high and 4 m wide through the middle of the land, along a line that the direction
/// `along_deg` follows.
AnalyticTiles::Height wall(double along_deg) {
  const double a = rad_from_deg(along_deg);
  return [a](double east, double north) {
    const double across = (east - 256.0) * std::cos(a) - (north + 256.0) * std::sin(a);
    return std::abs(across) <= 2.0 ? 30.0 : 0.0;
  };
}

TEST(Light, ShadowOfAWallIsItsHeightOverTheTangent) {
  for (const double elevation_deg : {20.0, 35.0, 50.0}) {
    for (const double azimuth_deg : {90.0, 270.0}) {
      LightOptions options = sun_at(azimuth_deg, elevation_deg);
      options.hill_shading = 0.0;
      options.ambient = 0.0;
      // Four tiles of 512 texels of 0.25 m: 512 m; the wall's west face stands at 254 m.
      const auto ground = grey_ground(wall(0.0), {0.0, 30.0});
      const int away = azimuth_deg == 90.0 ? -1 : 1;
      double shadow_end_m = 0.0;
      for (double out_m = 0.0; out_m < 100.0; out_m += 0.25) {
        const int texel = static_cast<int>((256.0 + away * (2.0 + out_m)) / 0.25);
        const int col = texel / kTileTexels;
        static Tile tile;
        static int held = -1;
        if (out_m == 0.0) held = -1;
        if (held != col) {
          tile = lit_tile(ground, options, {0, col, 1});
          held = col;
        }
        if (light_at(tile, texel % kTileTexels, 100) < 0.5) shadow_end_m = out_m;
      }
      const double expected_m = 30.0 / std::tan(rad_from_deg(elevation_deg));
      // The light's nodes are 2 m apart here.
      EXPECT_NEAR(shadow_end_m, expected_m, 2.0) << elevation_deg << " deg, sun at " << azimuth_deg;
    }
  }
}

TEST(Light, ShadowPointsAwayFromTheSun) {
  // A tower of 6 m width and 60 m height at the middle of tile (1, 1) of level 0, 128 m a side.
  const auto tower = grey_ground(
      [](double east, double north) {
        return std::hypot(east - 192.0, north + 192.0) <= 3.0 ? 60.0 : 0.0;
      },
      {0.0, 60.0});
  for (const double azimuth_deg : {10.0, 75.0, 160.0, 222.0, 301.0}) {
    LightOptions options = sun_at(azimuth_deg, 50.0);
    options.hill_shading = 0.0;
    const Tile tile = lit_tile(tower, options, {0, 1, 1});
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int y = 0; y < kTileTexels; ++y) {
      for (int x = 0; x < kTileTexels; ++x) {
        const Eigen::Vector2d from_tower((x + 0.5) * 0.25 - 64.0, 64.0 - (y + 0.5) * 0.25);
        if (from_tower.norm() < 8.0) continue;
        sum += (1.0 - light_at(tile, x, y)) * from_tower;
      }
    }
    const double shadow_deg = deg_from_rad(std::atan2(sum.x(), sum.y()));
    EXPECT_NEAR(std::remainder(shadow_deg - (azimuth_deg + 180.0), 360.0), 0.0, 1.0)
        << "sun at " << azimuth_deg;
  }
}

TEST(Light, CloudsCoverTheShareOfTheGroundThatWasAsked) {
  const auto flat = grey_ground([](double, double) { return 0.0; }, {0.0, 0.0}, 8.0, 4);
  for (const double cover : {0.1, 0.5}) {
    LightOptions options = sun_at(180.0, 45.0);
    options.ambient = 0.0;
    options.clouds = {.cover = cover, .size_m = 300.0, .strength = 0.5, .seed = 5};
    double taken = 0.0;
    for (int k = 0; k < 4; ++k) {
      const Tile tile = lit_tile(flat, options, {0, k % 2, k / 2});
      for (int y = 0; y < kTileTexels; ++y) {
        for (int x = 0; x < kTileTexels; ++x) taken += (1.0 - light_at(tile, x, y)) / 0.5;
      }
    }
    EXPECT_NEAR(taken / (4.0 * kTileTexels * kTileTexels), cover, 0.05);
  }
}

TEST(Light, AnotherSeedGivesOtherCloudsAndTheSameSeedTheSame) {
  const auto flat = grey_ground([](double, double) { return 0.0; }, {0.0, 0.0}, 2.0, 1);
  LightOptions options = sun_at(180.0, 45.0);
  options.clouds.cover = 0.4;
  const Tile once = lit_tile(flat, options, {0, 0, 0});
  EXPECT_EQ(once.rgb.data, lit_tile(flat, options, {0, 0, 0}).rgb.data);
  options.clouds.seed = 2;
  EXPECT_NE(once.rgb.data, lit_tile(flat, options, {0, 0, 0}).rgb.data);
}

/// Hills, shading, shadows and clouds all at once, over imagery with texture.
class LitWorld : public ::testing::Test {
 protected:
  LitWorld() {
    testing::SyntheticWorldOptions options;
    options.relief_m = 120.0;
    auto opened = open_world(testing::write_synthetic_world(folder_.path(), options));
    if (!opened) throw std::runtime_error(opened.error().message);
    plain_ = opened->tiles;
    LightOptions light = sun_at(250.0, 18.0);
    light.clouds = {.cover = 0.3, .size_m = 150.0, .strength = 0.8, .seed = 3};
    auto lit = with_light(plain_, light);
    if (!lit) throw std::runtime_error(lit.error().message);
    lit_ = *lit;
  }
  testing::TemporaryFolder folder_;
  std::shared_ptr<const TileSource> plain_;
  std::shared_ptr<const TileSource> lit_;
};

TEST_F(LitWorld, NeighboursAgreeInTheirBordersExactly) {
  for (int level = 0; level < 2; ++level) {
    const Tile tile = *lit_->tile({level, 0, 0});
    const Tile east = *lit_->tile({level, 1, 0});
    const Tile south = *lit_->tile({level, 0, 1});
    int different = 0;
    for (int along = 0; along < kTileSide; ++along) {
      for (int across = 0; across < 2 * kTileBorder; ++across) {
        for (int c = 0; c < 3; ++c) {
          different += tile.rgb.at(kTileTexels + across, along, c) != east.rgb.at(across, along, c);
          different +=
              tile.rgb.at(along, kTileTexels + across, c) != south.rgb.at(along, across, c);
        }
      }
    }
    EXPECT_EQ(different, 0) << "level " << level;
  }
}

TEST_F(LitWorld, LevelsAreAveragesOfFinerOnes) {
  const Tile coarse = *lit_->tile({1, 0, 0});
  const Tile coarse_plain = *plain_->tile({1, 0, 0});
  const Tile fine = *lit_->tile({0, 0, 0});
  const int half = kTileTexels / 2;
  double difference = 0.0;
  double effect = 0.0;
  for (int y = 0; y < half; ++y) {
    for (int x = 0; x < half; ++x) {
      double mean = 0.0;
      for (int k = 0; k < 4; ++k) {
        mean += 0.25 * fine.rgb.at(kTileBorder + 2 * x + k % 2, kTileBorder + 2 * y + k / 2);
      }
      const int here = coarse.rgb.at(kTileBorder + x, kTileBorder + y);
      difference += std::abs(here - mean);
      effect += std::abs(here - coarse_plain.rgb.at(kTileBorder + x, kTileBorder + y));
    }
  }
  // The stated tolerance: one grey level in the mean, where the light changes many.
  EXPECT_LT(difference / (half * half), 1.0);
  EXPECT_GT(effect / (half * half), 10.0);
}

TEST_F(LitWorld, VoidTexelsKeepTheirColour) {
  const Tile tile = *lit_->tile({0, 2, 2});
  int voids = 0;
  for (std::size_t i = 0; i < tile.valid.data.size(); ++i) {
    if (tile.valid.data[i] != 0) continue;
    ++voids;
    ASSERT_EQ(tile.rgb.data[3 * i], kVoidRgb[0]);
  }
  EXPECT_GT(voids, 1000);
}

TEST(Light, NamesTheFieldThatIsOutOfItsLimits) {
  const auto flat = grey_ground([](double, double) { return 0.0; }, {0.0, 0.0});
  const auto message = [&](const LightOptions& options) {
    const auto lit = with_light(flat, options);
    return lit ? std::string("accepted") : lit.error().message;
  };
  EXPECT_NE(message(sun_at(90.0, -3.0)).find("light.sun_elevation_deg = -3"), std::string::npos);
  LightOptions options;
  options.ambient = 1.5;
  EXPECT_NE(message(options).find("light.ambient = 1.5"), std::string::npos);
  options = {};
  options.clouds.size_m = 1.0;
  EXPECT_NE(message(options).find("light.clouds.size_m = 1"), std::string::npos);
}

TEST(Drape, StretchIsOneOverTheCosineOfTheSlope) {
  for (const double slope_deg : {0.0, 30.0, 60.0, 75.0}) {
    const double rise = std::tan(rad_from_deg(slope_deg));
    const auto ramp =
        grey_ground([&](double, double north) { return rise * north; }, {-2000.0, 0.0});
    EXPECT_NEAR(drape_stretch(*ramp, 100.0, -60.0), 1.0 / std::cos(rad_from_deg(slope_deg)), 1e-9);
  }
}

TEST(Drape, ShareOfTheGroundCountsOnlyWhatIsSteeperThanTheLimit) {
  // A quarter of the land slopes by 61 deg, the rest by 59 deg.
  const auto land = grey_ground(
      [](double east, double) {
        const double steep_m = std::min(east, 128.0);
        return steep_m * std::tan(rad_from_deg(61.0)) +
               std::max(0.0, east - 128.0) * std::tan(rad_from_deg(59.0));
      },
      {0.0, 2000.0});
  EXPECT_NEAR(stretched_share(*land), 0.25, 0.01);
}

}  // namespace
}  // namespace overfly::terrain
