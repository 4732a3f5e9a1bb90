// Series in bounded memory: nothing is lost of short ones, and no spike of long ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/measure/bounded_series.hpp"

namespace overfly {
namespace {

TEST(BoundedSeries, KeepsAllOfAShortSeries) {
  BoundedSeries series(1, 100);
  std::vector<SeriesPoint> points;
  for (int i = 0; i < 100; ++i) points.push_back({i * 20'000'000LL, {std::sin(i), 1.0 * i, 2.0}});
  for (const SeriesPoint& point : points) series.add(point);
  EXPECT_EQ(series.points(), points);
  EXPECT_EQ(series.count(), 100U);
  EXPECT_TRUE(BoundedSeries(3, 10).points().empty());
}

TEST(BoundedSeries, KeepsTheExtremesOfEveryIntervalAndChannel) {
  constexpr std::size_t kIntervals = 64;
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise;
  BoundedSeries series(3, kIntervals);
  std::vector<SeriesPoint> all;
  for (int i = 0; i < 200'000; ++i) {
    SeriesPoint point{i * 10'000'000LL, {noise(random), noise(random), noise(random)}};
    // Spikes of single samples.
    if (i % 17'321 == 5) point.values[static_cast<std::size_t>(i % 3)] = 50.0 + i * 1e-3;
    all.push_back(point);
    series.add(point);
  }
  const std::vector<SeriesPoint> kept = series.points();
  EXPECT_LE(kept.size(), 6 * kIntervals + 2);
  EXPECT_GT(kept.size(), 3 * kIntervals / 2);
  EXPECT_EQ(kept.front(), all.front());
  EXPECT_EQ(kept.back(), all.back());
  EXPECT_TRUE(std::is_sorted(
      kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.t_ns < b.t_ns; }));
  // Every sample that was kept is one of the series, and every spike was kept.
  std::size_t spikes = 0;
  for (const SeriesPoint& point : kept) {
    EXPECT_EQ(point, all[static_cast<std::size_t>(point.t_ns / 10'000'000)]);
    spikes += *std::max_element(point.values.begin(), point.values.end()) > 40.0;
  }
  EXPECT_EQ(spikes, 12U);
  // The intervals are 1 ms doubled until at most kIntervals have samples: 2^15 ms, 62 of them. In
  // each of them the smallest and largest value are those of all samples.
  const std::int64_t width_ns = 1'000'000LL << 15U;
  const auto range = [&](const std::vector<SeriesPoint>& points, std::int64_t number, auto value) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const SeriesPoint& point : points) {
      if (point.t_ns / width_ns != number) continue;
      low = std::min(low, value(point));
      high = std::max(high, value(point));
    }
    return std::pair(low, high);
  };
  const std::int64_t numbers = all.back().t_ns / width_ns + 1;
  EXPECT_GE(numbers, 30);
  EXPECT_LE(numbers, static_cast<std::int64_t>(kIntervals));
  for (std::int64_t number = 0; number < numbers; ++number) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const auto value = [&](const SeriesPoint& point) { return point.values[channel]; };
      EXPECT_EQ(range(kept, number, value), range(all, number, value)) << channel << " " << number;
    }
  }
}

TEST(BoundedSeries, TakesTimesInAnyOrderAndOfAnySize) {
  BoundedSeries series(1, 16);
  std::mt19937_64 random(2);
  std::vector<std::int64_t> times = {
      std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max(), 0, -1, 1};
  for (int i = 0; i < 1000; ++i) times.push_back(static_cast<std::int64_t>(random()));
  for (const std::int64_t t_ns : times) series.add({t_ns, {1e-9 * static_cast<double>(t_ns)}});
  const auto kept = series.points();
  EXPECT_LE(kept.size(), 34U);
  EXPECT_EQ(kept.front().t_ns, std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(kept.back().t_ns, std::numeric_limits<std::int64_t>::max());
}

}  // namespace
}  // namespace overfly
