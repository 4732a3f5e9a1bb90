#include "calibration/coverage.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/calibration/sample_views.hpp"

namespace overfly::calibration {
namespace {

/// Corners of a board of 4 x 3 at p = origin + column u + row v [px].
BoardView sheared(const Eigen::Vector2d& origin,
                  const Eigen::Vector2d& u,
                  const Eigen::Vector2d& v) {
  BoardView view;
  for (int id = 0; id < 12; ++id)
    view.corners.push_back({id, origin + (id % 4) * u + (id / 4) * v});
  return view;
}

const Board kSmall{4, 3, 0.1};

TEST(Coverage, OfAnUprightBoardFollowsFromItsRectangle) {
  // 300 x 100 px: area 30000, border 173.205; centre (350, 250) in 640 x 480.
  const ViewMeasures m = measures_of(sheared({200, 200}, {100, 0}, {0, 50}), kSmall, 640, 480);
  const double border = std::sqrt(30000.0);
  EXPECT_NEAR(m.x, (350 - border / 2) / (640 - border), 1e-12);
  EXPECT_NEAR(m.y, (250 - border / 2) / (480 - border), 1e-12);
  EXPECT_NEAR(m.size, std::sqrt(30000.0 / (640.0 * 480.0)), 1e-12);
  EXPECT_NEAR(m.skew, 0.0, 1e-12);
}

TEST(Coverage, SkewIsTwiceTheAngleFromASquareCorner) {
  const double lean = 0.2;
  const ViewMeasures m = measures_of(
      sheared({200, 200}, {100, 0}, {50 * std::sin(lean), 50 * std::cos(lean)}), kSmall, 640, 480);
  EXPECT_NEAR(m.skew, 2.0 * lean, 1e-12);
}

TEST(Coverage, BarsGrowWithTheRangeAndSizeCountsFromZero) {
  ViewMeasures a;
  a.x = 0.2;
  a.y = 0.5;
  a.size = 0.3;
  a.skew = 0.1;
  std::vector<CoverageBar> bars = coverage_bars({a});
  ASSERT_EQ(bars.size(), 4U);
  EXPECT_DOUBLE_EQ(bars[0].progress, 0.0);
  EXPECT_DOUBLE_EQ(bars[2].progress, 0.3 / 0.4);
  EXPECT_DOUBLE_EQ(bars[3].progress, 0.1 / 0.5);
  ViewMeasures b = a;
  b.x = 0.9;
  bars = coverage_bars({a, b});
  EXPECT_NEAR(bars[0].progress, 1.0, 1e-12);
  EXPECT_DOUBLE_EQ(bars[0].min, 0.2);
  EXPECT_DOUBLE_EQ(bars[0].max, 0.9);
  for (const CoverageBar& bar : coverage_bars({})) EXPECT_DOUBLE_EQ(bar.progress, 0.0);
}

}  // namespace
}  // namespace overfly::calibration
