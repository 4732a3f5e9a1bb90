// Rays that pass whole squares of the ground against rays that visit every cell: on random terrain,
// cliffs, holes and edges.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>

#include "renderer/raycast/ground/ground_caster.hpp"
#include "tests/renderer/procedural_ground.hpp"

namespace overfly::renderer::raycast {
namespace {

using overfly::testing::ProceduralGround;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Visits one cell of the leaves after the other, and nothing else.
class CellByCell {
 public:
  CellByCell(const GroundTree& tree,
             const Eigen::Vector3d& origin,
             const Eigen::Vector3d& direction)
      : tree_(tree), o_(origin), d_(direction) {}

  struct Hit {
    double depth = kNever;
    bool near_edge = false;  ///< of its cell: a neighbouring cell may have it as well
  };

  [[nodiscard]] Hit first() const {
    double t = 0.0;
    for (int steps = 0; steps < 2'000'000; ++steps) {
      const GroundNode* node = nullptr;
      double low_e = 0.0, low_n = 0.0, side_m = 0.0;
      if (!find(t, node, low_e, low_n, side_m)) return {};
      const double out =
          std::min(exit(o_.x(), d_.x(), low_e, side_m), exit(o_.y(), d_.y(), low_n, side_m));
      const double end = std::max(out, t + 1e-9 * (1.0 + t));
      if (node != nullptr) {
        const double depth = enter(*node, low_e, low_n, t, end);
        if (depth < kNever) return {depth, std::min(depth - t, end - depth) < 1e-6 * depth};
      }
      if (!(end < 1e7)) return {};
      t = end;
    }
    return {};
  }

 private:
  static double exit(double from, double rate, double low, double side_m) {
    if (rate == 0.0) return kNever;
    return ((rate > 0.0 ? low + side_m : low) - from) / rate;
  }

  /// The cell of a leaf, or the square without ground, that the ray enters at t; false outside.
  bool find(double t, const GroundNode*& node, double& low_e, double& low_n, double& side_m) const {
    const double e = o_.x() + t * d_.x() + std::copysign(1e-7, d_.x());
    const double n = o_.y() + t * d_.y() + std::copysign(1e-7, d_.y());
    const int column = static_cast<int>(std::floor((e - tree_.east_m) / tree_.side_m));
    const int row = static_cast<int>(std::floor((n - tree_.north_m) / tree_.side_m));
    if (column < 0 || column > 2 || row < 0 || row > 2) return false;
    std::int32_t at = tree_.roots[row * 3 + column];
    side_m = tree_.side_m;
    low_e = tree_.east_m + column * side_m;
    low_n = tree_.north_m + row * side_m;
    while (at >= 0 && !tree_.nodes[at].leaf) {
      side_m *= 0.5;
      const int east = e >= low_e + side_m ? 1 : 0;
      const int north = n >= low_n + side_m ? 1 : 0;
      at = tree_.nodes[at].children[2 * north + east];
      low_e += east * side_m;
      low_n += north * side_m;
    }
    node = at < 0 ? nullptr : &tree_.nodes[at];
    if (node == nullptr) return true;
    side_m = node->tile->spacing_m;
    low_e = node->east_m + std::clamp(std::floor((e - node->east_m) / side_m), 0.0, 31.0) * side_m;
    low_n =
        node->north_m + std::clamp(std::floor((n - node->north_m) / side_m), 0.0, 31.0) * side_m;
    return true;
  }

  /// Where the ray first is not above a cell's bilinear surface, by its height at 64 places and
  /// bisection: no formula of the caster.
  [[nodiscard]] double enter(
      const GroundNode& node, double low_e, double low_n, double from, double to) const {
    const HeightTile& tile = *node.tile;
    const int column = static_cast<int>(std::lround((low_e - node.east_m) / tile.spacing_m));
    const int row = static_cast<int>(std::lround((low_n - node.north_m) / tile.spacing_m));
    const double sw = tile.height(column, row), se = tile.height(column + 1, row);
    const double nw = tile.height(column, row + 1), ne = tile.height(column + 1, row + 1);
    const auto above = [&](double t) {
      const double a = (o_.x() + t * d_.x() - low_e) / tile.spacing_m;
      const double b = (o_.y() + t * d_.y() - low_n) / tile.spacing_m;
      return o_.z() + t * d_.z() - tile.up_m -
             ((1 - b) * ((1 - a) * sw + a * se) + b * ((1 - a) * nw + a * ne));
    };
    if (std::min({sw, se, nw, ne}) + tile.up_m >
        std::max(o_.z() + from * d_.z(), o_.z() + to * d_.z())) {
      return from;
    }
    if (std::max({sw, se, nw, ne}) + tile.up_m <
        std::min(o_.z() + from * d_.z(), o_.z() + to * d_.z())) {
      return kNever;
    }
    if (above(from) <= 0.0) return from;
    double high = from;
    for (int i = 1; i <= 64; ++i) {
      const double t = from + (to - from) * i / 64.0;
      if (above(t) > 0.0) {
        high = t;
        continue;
      }
      double low = t;
      for (int j = 0; j < 60; ++j)
        (above(0.5 * (low + high)) > 0.0 ? high : low) = 0.5 * (low + high);
      return low;
    }
    return kNever;
  }

  const GroundTree& tree_;
  Eigen::Vector3d o_, d_;
};

/// A pseudo-random height in [-1, 1] at whole places.
double at_random(int seed, int i, int j) {
  std::uint32_t x = static_cast<std::uint32_t>(seed) * 0x9E3779B9U +
                    static_cast<std::uint32_t>(i) * 0x85EBCA6BU +
                    static_cast<std::uint32_t>(j) * 0xC2B2AE35U;
  x = (x ^ (x >> 15U)) * 0x2C1B3C6DU;
  x = (x ^ (x >> 12U)) * 0x297A2D39U;
  return static_cast<double>(x ^ (x >> 15U)) / 2147483648.0 - 1.0;
}

/// Relief of every size from 2 m to 500 m.
double rough_m(int seed, double east_m, double north_m) {
  double height_m = 0.0;
  for (double size_m = 500.0; size_m > 2.0; size_m *= 0.45) {
    const double e = east_m / size_m, n = north_m / size_m;
    const int i = static_cast<int>(std::floor(e)), j = static_cast<int>(std::floor(n));
    const double a = e - i, b = n - j;
    height_m += 0.12 * size_m *
                ((1 - b) * ((1 - a) * at_random(seed, i, j) + a * at_random(seed, i + 1, j)) +
                 b * ((1 - a) * at_random(seed, i, j + 1) + a * at_random(seed, i + 1, j + 1)));
  }
  return height_m;
}

struct Terrain {
  std::string name;
  std::function<double(double, double)> height_m;
};

std::vector<Terrain> terrains() {
  std::vector<Terrain> all;
  for (const int seed : {1, 2, 3}) {
    all.push_back({"rough " + std::to_string(seed),
                   [seed](double e, double n) { return rough_m(seed, e, n); }});
  }
  all.push_back({"hills", overfly::testing::hills_m});
  all.push_back({"plane", [](double, double) { return 0.0; }});
  // Walls of 40 m: houses and quarries.
  all.push_back({"cliffs", [](double e, double n) {
                   return std::floor(0.013 * e) + std::floor(0.017 * n) > 2.0 * std::sin(0.004 * e)
                              ? 40.0
                              : 0.01 * n;
                 }});
  // Ground that ends, and holes in it, as far down as ground without data is drawn.
  all.push_back({"holes", [](double e, double n) {
                   const bool hole = at_random(7,
                                               static_cast<int>(std::floor(e / 90.0)),
                                               static_cast<int>(std::floor(n / 90.0))) > 0.6;
                   return hole ? -1e6 : 0.3 * rough_m(5, e, n);
                 }});
  return all;
}

class GrazingRays : public ::testing::TestWithParam<int> {};

TEST_P(GrazingRays, MeetTheSameGroundAsCellByCell) {
  const Terrain terrain = terrains()[GetParam()];
  ProceduralGround::Options options;
  options.height_m = terrain.height_m;
  options.height_range_m = {-150.0, 150.0};
  HeightField field(std::make_shared<ProceduralGround>(options));
  std::mt19937 random(21);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int hits = 0, skies = 0, marched = 0;
  for (int view = 0; view < 3; ++view) {
    ViewSweep sweep;
    sweep.position = {400.0 * unit(random), 400.0 * unit(random), 160.0 + 100.0 * unit(random)};
    sweep.slack_m = 5.0;
    sweep.px_per_rad = 40.0;
    const GroundTree& tree = field.select(sweep);
    const GroundCaster caster(tree);
    for (int trial = 0; trial < 250; ++trial) {
      // From far above the horizon's ground down to 40 deg; some along an axis, some upwards.
      const double rise =
          trial % 20 == 0 ? 0.1 * unit(random) : -0.35 * (1.0 + unit(random)) - 0.01;
      const double turn = 4.0 * unit(random);
      Eigen::Vector3d direction(std::cos(turn), std::sin(turn), rise);
      if (trial % 9 == 1) direction.x() = 0.0;
      if (trial % 9 == 2) direction.y() = 0.0;
      direction *= std::exp(unit(random));
      Eigen::Vector3d origin = sweep.position;
      // A valley's camera looks at the ground from below its highest hill.
      if (trial % 5 == 3) origin.z() = terrain.height_m(origin.x(), origin.y()) + 3.0;
      // Where the search for the first square begins changes nothing.
      const GroundNode& any = tree.nodes[random() % tree.nodes.size()];
      const GroundHit hit = caster.cast(origin, direction, 0.0, trial % 2 == 0 ? &any : nullptr);
      const CellByCell::Hit expected = CellByCell(tree, origin, direction).first();
      const std::string where =
          terrain.name + ", view " + std::to_string(view) + ", trial " + std::to_string(trial);
      ASSERT_EQ(hit.sky(), !(expected.depth < kNever)) << where;
      (hit.sky() ? skies : hits) += 1;
      if (hit.sky()) continue;
      // Bisection, and rays along a surface, find the root less exactly.
      ASSERT_NEAR(hit.depth, std::max(expected.depth, 0.05), 1e-6 * expected.depth + 1e-9) << where;
      if (caster.meets_ground_once(direction)) continue;
      ++marched;
      for (const double guess : {0.2, 0.99, 1.0, 1.0 + 1e-9, 1.01, 3.0}) {
        const GroundHit again = caster.cast(origin, direction, guess * hit.depth, hit.node);
        ASSERT_EQ(again.depth, hit.depth) << where << ", guess " << guess;
        ASSERT_EQ(again.node, hit.node) << where;
        ASSERT_EQ(again.column, hit.column) << where;
        ASSERT_EQ(again.row, hit.row) << where;
        ASSERT_EQ(again.across, hit.across) << where;
        ASSERT_EQ(again.up, hit.up) << where;
      }
    }
  }
  EXPECT_GT(hits, 300);
  EXPECT_GT(skies, 5);
  if (terrain.name != "plane") EXPECT_GT(marched, 200);
}

INSTANTIATE_TEST_SUITE_P(Terrains, GrazingRays, ::testing::Range(0, 7));

}  // namespace
}  // namespace overfly::renderer::raycast
