// The pieces of the ground's mesh: patches that agree at their seams, squares that fit, no gaps.
#include "renderer/ground/ground_patch.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "renderer/ground/ground_squares.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer {
namespace {

using terrain::TileId;

TEST(GroundPatch, SharesPointsWithItsNeighboursAndParts) {
  GroundPatchStore store(overfly::testing::natural_ground());
  const auto sampled = [&](const TileId& id) {
    const auto patch = store.outline(id);
    store.sample(*patch);
    return patch;
  };
  for (const int level : {-6, -2, 0, 3}) {
    const auto here = sampled({level, 1, -2}), east = sampled({level, 2, -2});
    const auto south = sampled({level, 1, -1});
    const auto part = sampled({level - 1 < -6 ? level : level - 1, 2, -4});
    for (int i = 0; i <= kPatchCells; ++i) {
      EXPECT_EQ(here->point(kPatchCells, i), east->point(0, i));
      EXPECT_EQ(here->point(i, kPatchCells), south->point(i, 0));
      EXPECT_EQ(lattice_point(here->id, kPatchCells, i), lattice_point(east->id, 0, i));
      if (part->id.level == level || i % 2 != 0) continue;
      EXPECT_EQ(here->point(i / 2, 0), part->point(i, 0));
      EXPECT_EQ(lattice_point(here->id, i / 2, 0), lattice_point(part->id, i, 0));
    }
    for (int i = 0; i < 25; ++i) EXPECT_EQ(here->outline[i], here->point(i % 5 * 8, i / 5 * 8));
  }
}

TEST(GroundPatch, BoundsHoldItsGround) {
  const auto hills = overfly::testing::natural_ground();
  GroundPatchStore store(hills);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    const int level = static_cast<int>(random() % 10) - 6;
    const TileId id{level, static_cast<int>(random() % 4), static_cast<int>(random() % 4)};
    const auto patch = store.outline(id);
    const double size_m = 256.0 * std::exp2(level);
    EXPECT_DOUBLE_EQ(patch->size_map_m, size_m);
    const terrain::TileGrid& grid = hills->grid();
    for (int i = 0; i < 20; ++i) {
      const double x_m = grid.left_x_m + (id.col + unit(random)) * size_m;
      const double y_m = grid.top_y_m - (id.row + unit(random)) * size_m;
      Eigen::AlignedBox3d bounds = patch->bounds;
      bounds.extend(bounds.min() - Eigen::Vector3d(1e-6, 1e-6, 0.0));
      bounds.extend(bounds.max() + Eigen::Vector3d(1e-6, 1e-6, 0.0));
      ASSERT_TRUE(bounds.contains(hills->world_from_map(x_m, y_m))) << "level " << level;
    }
  }
}

TEST(GroundPatch, ErrorsOfAParabolaAreThoseOfItsChord) {
  constexpr double kBend = 0.01;  // per m
  overfly::testing::ProceduralGround::Options options;
  options.curved = false;
  options.height_m = [](double east_m, double) { return kBend * east_m * east_m; };
  GroundPatchStore store(std::make_shared<overfly::testing::ProceduralGround>(options));
  const auto patch = store.outline({0, 4, 4});  // 256 m from the origin to the south-east
  store.sample(*patch);
  for (int t = 0; t <= kLog2PatchCells; ++t) {
    const double half_side_m = 4.0 * (1 << t);
    const int squares = kPatchCells >> t;
    for (int i = 0; i < squares; ++i) {
      EXPECT_NEAR(patch->square_error(t, i, squares - 1 - i),
                  kBend * half_side_m * half_side_m,
                  1e-5 * half_side_m * half_side_m);
    }
  }
}

TEST(GroundPatchStore, KeepsPatchesWithinItsBudgetAndThoseInUse) {
  const auto hills = overfly::testing::natural_ground();
  GroundPatchStore store(hills, 400'000);  // some six sampled patches
  const auto first = store.outline({0, 0, 0});
  store.sample(*first);
  EXPECT_EQ(store.outline({0, 0, 0}), first);
  const std::vector<Eigen::Vector3d> points = first->points;
  for (int col = 1; col < 40; ++col) {
    store.sample(*store.outline({0, col, 0}));
    EXPECT_LE(store.held_bytes(), 400'000U);
  }
  EXPECT_EQ(first->points, points) << "still ours";
  const auto again = store.outline({0, 0, 0});
  EXPECT_NE(again, first);
  store.sample(*again);
  EXPECT_EQ(again->points, points);
}

TEST(GroundCorners, AreAMapInWhichTheFinestLevelWins) {
  std::mt19937 random(4);
  const std::vector<Eigen::Vector3d> points(64, Eigen::Vector3d::Zero());
  std::map<LatticePoint, std::pair<int, const Eigen::Vector3d*>> expected;
  GroundCorners corners;
  for (int i = 0; i < 60'000; ++i) {  // far more than the first table holds
    const LatticePoint at{static_cast<int>(random() % 200) - 100,
                          (static_cast<int>(random() % 200) - 100) * 65536};
    // One point for each place and level, because equal levels agree.
    const int level = static_cast<int>(random() % 8) - 4;
    const Eigen::Vector3d* point = &points[(at[0] + 100) % 8 * 8 + level + 4];
    corners.add(at, *point, level);
    const auto [entry, added] = expected.try_emplace(at, level, point);
    if (!added && level < entry->second.first) entry->second = {level, point};
  }
  EXPECT_GT(expected.size(), 20'000U);
  for (const auto& [at, best] : expected) EXPECT_EQ(corners.find(at), best.second);
  EXPECT_EQ(corners.find({101, 0}), nullptr);
  EXPECT_EQ(corners.find({0, 1}), nullptr);
}

/// Squares of a patch of hills in which the outline's corner is larger in the image.
TEST(GroundSquares, FillThePatchWithinTheLimits) {
  GroundPatchStore store(overfly::testing::natural_ground());
  const auto patch = store.outline({1, 1, 2});
  store.sample(*patch);
  GroundLeaf leaf;
  leaf.patch = patch.get();
  leaf.textured = true;
  for (int i = 0; i < 25; ++i) {
    const auto near = static_cast<float>(i % 5 + i / 5);  // to the south-east
    leaf.px_per_m_up[i] = 0.002F * near * near;
    leaf.px_per_map_m[i] = 0.02F + 0.03F * near;
  }
  const MeshLimits limits;
  GroundCorners corners;
  const std::vector<GroundSquare> squares = divide_into_squares(leaf, limits, corners);
  std::vector<int> covered(kPatchCells * kPatchCells, 0);
  std::vector<int> sizes(kLog2PatchCells + 1, 0);
  int bends = 0;
  for (const GroundSquare& square : squares) {
    const int side = 1 << square.t;
    ++sizes[square.t];
    float up = 0.0F, along = 0.0F;
    for (int row = square.row; row < square.row + side; ++row) {
      for (int column = square.column; column < square.column + side; ++column) {
        ++covered.at(row * kPatchCells + column);
        for (const int i : {0, 1, 5, 6}) {
          up = std::max(up, leaf.px_per_m_up[row / 8 * 5 + column / 8 + i]);
          along = std::max(along, leaf.px_per_map_m[row / 8 * 5 + column / 8 + i]);
        }
      }
    }
    // A neighbour's corner on a side of this square is known, so that the side bends there.
    const auto on_side = [&](int c, int r) {
      const bool within_c = c >= square.column && c <= square.column + side;
      const bool within_r = r >= square.row && r <= square.row + side;
      return within_c && within_r &&
             ((c - square.column) % side == 0 || (r - square.row) % side == 0);
    };
    for (const GroundSquare& other : squares) {
      for (int i = 0; i < 4; ++i) {
        const int c = other.column + (i & 1) * (1 << other.t);
        const int r = other.row + (i >> 1) * (1 << other.t);
        const bool own = (c - square.column) % side == 0 && (r - square.row) % side == 0;
        if (own || !on_side(c, r)) continue;
        EXPECT_EQ(corners.find(lattice_point(patch->id, c, r)), &patch->point(c, r));
        ++bends;
      }
    }
    if (square.t == 0) continue;
    EXPECT_LE(patch->square_error(square.t, square.column >> square.t, square.row >> square.t) * up,
              limits.max_error_px);
    EXPECT_LE(side * patch->size_map_m / kPatchCells * along, limits.max_edge_px);
  }
  EXPECT_EQ(std::count(covered.begin(), covered.end(), 1), kPatchCells * kPatchCells);
  EXPECT_GT(bends, 20);
  EXPECT_GE(std::count_if(sizes.begin(), sizes.end(), [](int n) { return n > 0; }), 3);
  // Ground of one colour may be drawn more coarsely.
  leaf.textured = false;
  EXPECT_LT(divide_into_squares(leaf, limits, corners).size(), squares.size());
}

}  // namespace
}  // namespace overfly::renderer
