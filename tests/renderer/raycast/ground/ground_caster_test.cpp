// Rays onto the ray-caster's ground against small steps along them, and its tiles against formulas.
#include "renderer/raycast/ground/ground_caster.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer::raycast {
namespace {

using overfly::testing::ProceduralGround;

std::shared_ptr<ProceduralGround> ground_of(std::function<double(double, double)> height_m,
                                            double low_m,
                                            double high_m) {
  ProceduralGround::Options options;
  options.height_m = std::move(height_m);
  options.height_range_m = {low_m, high_m};
  options.curved = false;
  return std::make_shared<ProceduralGround>(options);
}

/// Steep hills of 60 m, with slopes of up to three in one.
double crags_m(double east_m, double north_m) {
  return 30.0 * std::sin(east_m / 21.0) * std::sin(north_m / 17.0) +
         8.0 * std::sin(0.31 * east_m + 0.2 * north_m);
}

TEST(HeightTile, SamplesAPlaneAndItsPlaceOnTheMapExactly) {
  const auto ground = ground_of([](double e, double n) { return 5.0 + 0.3 * e - 0.4 * n; }, -1, 1);
  const TexelMap map = TexelMap::of(*ground);
  for (const HeightTileId id : {HeightTileId{0, 0, 0}, HeightTileId{4, -3, 7}}) {
    const HeightTile tile = HeightTile::sample(id, map);
    const double spacing_m = 0.125 * (1 << id.level);
    EXPECT_DOUBLE_EQ(tile.east_m, id.col * 32 * spacing_m);
    EXPECT_DOUBLE_EQ(tile.north_m, id.row * 32 * spacing_m);
    EXPECT_NEAR(tile.steepest, 0.5, 1e-4);
    EXPECT_NEAR(tile.hidden_m, 0.0, 1e-4);
    for (int row = 0; row <= kTileCells; row += 4) {
      for (int column = 0; column <= kTileCells; column += 4) {
        const double east_m = tile.east_m + column * spacing_m;
        const double north_m = tile.north_m + row * spacing_m;
        EXPECT_NEAR(tile.up_m + tile.height(column, row), 5.0 + 0.3 * east_m - 0.4 * north_m, 1e-4);
        // 4 km of texels of half a metre around the origin; rows run to the south.
        const Eigen::Vector2d texel = tile.texel + tile.texel_at(column, row).cast<double>();
        EXPECT_NEAR(texel.x(), 2.0 * east_m + 2048.0, 1e-3);
        EXPECT_NEAR(texel.y(), 2048.0 - 2.0 * north_m, 1e-3);
      }
    }
  }
}

TEST(HeightTile, DeviationOfAParabolaIsThatOfItsChord) {
  constexpr double kBend = 0.02;  // per m
  const auto ground = ground_of([](double e, double) { return kBend * e * e; }, 0, 1);
  const HeightTile tile = HeightTile::sample({2, -1, 0}, TexelMap::of(*ground));
  for (int k = 1; k <= kLog2TileCells; ++k) {
    const double half_side_m = 0.5 * (1 << k) * tile.spacing_m;
    for (int at = 0; at < kTileCells; at += 5) {
      EXPECT_NEAR(tile.deviation_m.at(k, {at, 31 - at}), kBend * half_side_m * half_side_m, 1e-5)
          << k;
    }
  }
  // A quarter of the deviation of two cells; the tile's bound takes the half, for kinks.
  EXPECT_GE(tile.hidden_m, kBend * 0.25 * tile.spacing_m * tile.spacing_m);
}

TEST(HeightTile, HighestPostsAndSlopesAreBounds) {
  const auto ground = ground_of(crags_m, -40, 40);
  const HeightTile tile = HeightTile::sample({3, 2, -2}, TexelMap::of(*ground));
  std::mt19937 random(5);
  for (int trial = 0; trial < 300; ++trial) {
    const int k = static_cast<int>(random() % (kLog2TileCells + 1));
    const int column = static_cast<int>(random() % kTileCells);
    const int row = static_cast<int>(random() % kTileCells);
    float highest = -1e9F;
    for (int r = row >> k << k; r <= (row >> k << k) + (1 << k); ++r) {
      for (int c = column >> k << k; c <= (column >> k << k) + (1 << k); ++c) {
        highest = std::max(highest, tile.height(c, r));
      }
    }
    EXPECT_EQ(tile.highest_m.at(k, {column, row}), highest);
    const float rise = tile.height(column + 1, row) - tile.height(column, row);
    EXPECT_LE(std::abs(rise) / tile.spacing_m, tile.steepest);
    const float north = tile.height(column, row + 1) - tile.height(column, row);
    const Eigen::Array2f slope = Eigen::Array2f(rise, north) / static_cast<float>(tile.spacing_m);
    EXPECT_TRUE((slope >= tile.lowest_slope.array()).all());
    EXPECT_TRUE((slope <= tile.highest_slope.array()).all());
  }
  float lowest = 1e9F;
  for (const GroundPost& post : tile.posts) lowest = std::min(lowest, post.height_m);
  EXPECT_EQ(tile.lowest_m, lowest);
}

/// The crags from 100 m, without bounds, as rays of every direction need them.
class CastRays : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    field_ = std::make_unique<HeightField>(ground_of(crags_m, -40, 40));
    ViewSweep sweep;
    sweep.position = {20.0, -30.0, 100.0};
    sweep.slack_m = 30.0;
    sweep.px_per_rad = 15.0;
    tree_ = &field_->select(sweep);
  }
  static void TearDownTestSuite() { field_.reset(); }

  /// The leaf below a place, found from the roots; null outside the tree.
  [[nodiscard]] const GroundNode* leaf_below(double east_m, double north_m) const {
    for (const std::int32_t root : tree_->roots) {
      if (root < 0 || !tree_->nodes[root].holds(east_m, north_m)) continue;
      const GroundNode* node = &tree_->nodes[root];
      while (!node->leaf) {
        const auto child =
            std::find_if(node->children.begin(), node->children.end(), [&](std::int32_t i) {
              return i >= 0 && tree_->nodes[i].holds(east_m, north_m);
            });
        if (child == node->children.end()) return nullptr;
        node = &tree_->nodes[*child];
      }
      return node;
    }
    return nullptr;
  }

  /// Height of a point above the leaves' bilinear surface; infinite outside the tree.
  [[nodiscard]] double clearance_m(const Eigen::Vector3d& p) const {
    const GroundNode* leaf = leaf_below(p.x(), p.y());
    if (leaf == nullptr) return 1e9;
    const HeightTile& tile = *leaf->tile;
    const double e = (p.x() - tile.east_m) / tile.spacing_m;
    const double n = (p.y() - tile.north_m) / tile.spacing_m;
    const int column = std::clamp(static_cast<int>(e), 0, kTileCells - 1);
    const int row = std::clamp(static_cast<int>(n), 0, kTileCells - 1);
    const double a = e - column, b = n - row;
    const double south = (1 - a) * tile.height(column, row) + a * tile.height(column + 1, row);
    const double north =
        (1 - a) * tile.height(column, row + 1) + a * tile.height(column + 1, row + 1);
    return p.z() - tile.up_m - ((1 - b) * south + b * north);
  }

  /// A hit is where the ray enters the ground; before it, or without one, the ray is above it.
  void expect_first_entry(const Eigen::Vector3d& origin,
                          const Eigen::Vector3d& direction,
                          const GroundHit& hit) const {
    const double end_m = hit.sky() ? 600.0 : hit.depth - 1e-4;
    for (double t = 0.0; t < end_m; t += 0.2) {
      ASSERT_GT(clearance_m(origin + t * direction), -1e-4) << t << " m of " << hit.depth;
    }
    if (hit.sky()) return;
    ASSERT_GT(clearance_m(origin + (hit.depth - 1e-4) * direction), -1e-4);
    ASSERT_LT(clearance_m(origin + (hit.depth + 1e-4) * direction), 1e-3);
  }

  inline static std::unique_ptr<HeightField> field_;
  inline static const GroundTree* tree_ = nullptr;
};

TEST_F(CastRays, EnterTheGroundWhereSmallStepsDo) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const GroundCaster caster(*tree_);
  int hits = 0, skies = 0;
  for (int trial = 0; trial < 400; ++trial) {
    Eigen::Vector3d origin(20.0 + 60.0 * unit(random), -30.0 + 60.0 * unit(random), 0.0);
    // From just above the ground to above all hills.
    const double above_m = trial % 3 == 0 ? 0.5 : 50.0 + 49.0 * unit(random);
    origin.z() -= clearance_m(origin) - above_m;
    // Steep, grazing and rising rays; some along an axis.
    const double rise = trial % 4 == 0 ? unit(random) : 0.15 * unit(random) - 0.1;
    Eigen::Vector3d direction(unit(random), unit(random), rise);
    if (trial % 10 == 1) direction.x() = 0.0;
    if (trial % 10 == 2) direction.y() = 0.0;
    direction.normalize();
    const GroundHit hit = caster.cast(origin, direction, 0.0);
    expect_first_entry(origin, direction, hit);
    if (HasFatalFailure()) FAIL() << "trial " << trial;
    (hit.sky() ? skies : hits) += 1;
  }
  EXPECT_GT(hits, 100);
  EXPECT_GT(skies, 20);
}

TEST_F(CastRays, GuessesAndLengthsChangeNoHit) {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const GroundCaster caster(*tree_);
  int once = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Eigen::Vector3d origin(50.0 * unit(random), 50.0 * unit(random), 100.0);
    const Eigen::Vector3d direction(0.4 * unit(random), 0.4 * unit(random), -1.0);
    const GroundHit marched = caster.cast(origin, direction, 0.0);
    ASSERT_FALSE(marched.sky());
    once += caster.meets_ground_once(direction) ? 1 : 0;
    for (const double guess : {0.5, 1.0, 1.5}) {
      const GroundHit hit = caster.cast(origin, direction, guess * marched.depth);
      ASSERT_NEAR(hit.depth, marched.depth, 2e-5 * marched.depth);
      EXPECT_NEAR((hit.texel() - marched.texel()).norm(), 0.0, 0.02);
    }
    const GroundHit longer = caster.cast(origin, 7.0 * direction, 0.0);
    EXPECT_NEAR(7.0 * longer.depth, marched.depth, 1e-6);
  }
  EXPECT_GT(once, 50) << "rays of both methods";
}

TEST_F(CastRays, HitsTellTheMapAndTheSlope) {
  const GroundCaster caster(*tree_);
  std::mt19937 random(13);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Vector3d origin(60.0 * unit(random), 60.0 * unit(random), 100.0);
    const GroundHit hit = caster.cast(origin, {0.0, 0.0, -1.0}, 0.0);
    ASSERT_FALSE(hit.sky());
    EXPECT_NEAR(hit.texel().x(), 2.0 * origin.x() + 2048.0, 1e-2);
    EXPECT_NEAR(hit.texel().y(), 2048.0 - 2.0 * origin.y(), 1e-2);
    EXPECT_NEAR(
        (hit.texels_per_m() - Eigen::Vector2d(2.0, -2.0).asDiagonal().toDenseMatrix()).norm(),
        0.0,
        1e-2);
    // Within a cell the surface is linear along each axis.
    const double h = 1e-3 * std::min(hit.across, 1.0 - hit.across) * hit.node->tile->spacing_m;
    if (h < 1e-5) continue;
    const Eigen::Vector3d step(h, 0.0, 0.0);
    EXPECT_NEAR(hit.slope().x(),
                (clearance_m(origin - step) - clearance_m(origin + step)) / (2.0 * h),
                1e-6);
  }
}

TEST_F(CastRays, FromBelowTheGroundMeetItAtOnce) {
  const GroundCaster caster(*tree_);
  Eigen::Vector3d origin(3.0, 4.0, 0.0);
  origin.z() -= clearance_m(origin) + 0.8;
  for (const Eigen::Vector3d& direction : {Eigen::Vector3d(0.1, 0.2, -1.0),
                                           Eigen::Vector3d(1.0, 0.0, 0.0),
                                           Eigen::Vector3d(0.0, 0.0, 1.0)}) {
    for (const double guess : {0.0, 5.0}) {
      const GroundHit hit = caster.cast(origin, direction, guess);
      ASSERT_FALSE(hit.sky());
      EXPECT_DOUBLE_EQ(hit.depth, 0.05);
    }
  }
}

}  // namespace
}  // namespace overfly::renderer::raycast
