#include "server/report/plot/series.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace overfly::server::plot {
namespace {

/// Ten minutes at 31 Hz.
std::vector<Point> noisy_line(std::size_t count = 18600) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  std::vector<Point> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back({static_cast<double>(i) / 31.0, noise(random)});
  }
  return points;
}

std::size_t gaps_in(const std::vector<Point>& points) {
  return static_cast<std::size_t>(
      std::count_if(points.begin(), points.end(), [](const Point& p) { return p.is_gap(); }));
}

TEST(Series, DecimationKeepsTheLimitTheEndsAndEveryPeak) {
  std::vector<Point> points = noisy_line();
  points[7000].y = 500.0;  // one frame
  points[7001].y = -400.0;
  const std::vector<Point> drawn = decimated(points);
  EXPECT_LE(drawn.size(), kMaxPoints);
  EXPECT_GT(drawn.size(), kMaxPoints / 2);
  EXPECT_EQ(drawn.front().x, points.front().x);
  EXPECT_EQ(drawn.back().x, points.back().x);
  EXPECT_EQ(y_range_of({{"", 0, drawn}}).high, 500.0);
  EXPECT_EQ(y_range_of({{"", 0, drawn}}).low, -400.0);
  EXPECT_TRUE(std::is_sorted(
      drawn.begin(), drawn.end(), [](const Point& a, const Point& b) { return a.x < b.x; }));
  // Within each hundredth of the line the extremes are the same.
  for (std::size_t part = 0; part < 100; ++part) {
    const double from = 6.0 * static_cast<double>(part);
    const auto highest = [&](const std::vector<Point>& line) {
      double high = -1e9;
      for (const Point& point : line) {
        if (point.x >= from && point.x < from + 6.0) high = std::max(high, point.y);
      }
      return high;
    };
    EXPECT_EQ(highest(drawn), highest(points)) << part;
  }
}

TEST(Series, ShortLinesStayAsTheyAre) {
  const std::vector<Point> points = noisy_line(kMaxPoints);
  EXPECT_EQ(decimated(points).size(), points.size());
  EXPECT_TRUE(decimated({}).empty());
}

TEST(Series, GapsStayGaps) {
  std::vector<Point> points = noisy_line();
  for (std::size_t i = 9000; i < 9600; ++i) points[i].y = kGap;  // 20 s
  points[12000].y = kGap;                                        // one frame
  const std::vector<Point> drawn = decimated(points);
  EXPECT_LE(drawn.size(), kMaxPoints);
  for (std::size_t i = 1; i < drawn.size(); ++i) {
    const bool joined = !drawn[i - 1].is_gap() && !drawn[i].is_gap();
    const bool across = drawn[i - 1].x <= points[8999].x && drawn[i].x >= points[9600].x;
    EXPECT_FALSE(joined && across);
    EXPECT_FALSE(joined && drawn[i].x - drawn[i - 1].x > 5.0);
  }
  EXPECT_GE(gaps_in(drawn), 2U);
  const std::vector<Point> nothing(5000, Point{1.0, kGap});
  EXPECT_LE(decimated(nothing).size(), 1U);
}

/// A path goes back and forth: its extremes in both directions stay.
TEST(Series, DecimationOfAPathKeepsItsExtent) {
  std::vector<Point> circle;
  for (int i = 0; i < 20000; ++i) {
    const double angle = 40.0 * i / 20000.0;
    circle.push_back({100.0 * std::cos(angle), 100.0 * std::sin(angle)});
  }
  circle[11111] = {321.0, -5.0};
  const std::vector<Point> drawn = decimated(circle);
  EXPECT_LE(drawn.size(), kMaxPoints);
  EXPECT_EQ(x_range_of({{"", 0, drawn}}).high, 321.0);
  EXPECT_EQ(x_range_of({{"", 0, drawn}}).low, x_range_of({{"", 0, circle}}).low);
  EXPECT_EQ(y_range_of({{"", 0, drawn}}).high, y_range_of({{"", 0, circle}}).high);
}

TEST(Series, AnglesHaveNoSpikeWhereTheyWrap) {
  const std::vector<Point> yaw = {{0, 358}, {1, 359}, {2, 1}, {3, 2}, {4, 359}, {5, 200}};
  const std::vector<Point> line = with_gaps_at_wraps(yaw, 360.0);
  ASSERT_EQ(line.size(), 8U);
  EXPECT_TRUE(line[2].is_gap());
  EXPECT_TRUE(line[5].is_gap());
  EXPECT_EQ(line[3].y, 1.0);
  EXPECT_EQ(with_gaps_at_wraps({{0, 10}, {1, kGap}, {2, 350}}, 360.0).size(), 3U);
}

}  // namespace
}  // namespace overfly::server::plot
