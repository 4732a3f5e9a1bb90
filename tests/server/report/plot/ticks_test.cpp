#include "server/report/plot/ticks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace overfly::server::plot {
namespace {

TEST(Ticks, OfKnownRanges) {
  const Ticks minute = nice_ticks({0.0, 60.0}, 7);
  EXPECT_EQ(minute.values, (std::vector<double>{0, 10, 20, 30, 40, 50, 60}));
  EXPECT_EQ(minute.decimals, 0);
  const Ticks turn = nice_ticks({-180.0, 180.0}, 5);
  EXPECT_EQ(turn.values, (std::vector<double>{-100, 0, 100}));
  const Ticks small = nice_ticks({0.013, 0.031}, 5);
  ASSERT_EQ(small.values.size(), 4U);
  EXPECT_NEAR(small.values.front(), 0.015, 1e-12);
  EXPECT_NEAR(small.values.back(), 0.030, 1e-12);
  EXPECT_EQ(small.decimals, 3);
}

/// Of any range: in it, evenly spaced by 1, 2 or 5 times a power of ten, and with a finer step they
/// would be too many.
TEST(Ticks, AreNiceWhateverTheRange) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> exponent(-7.0, 7.0);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    const double span = std::pow(10.0, exponent(random));
    const double low = share(random) * 3.0 * span;
    const int most = 2 + i % 12;
    const Range range{low, low + span};
    const Ticks ticks = nice_ticks(range, most);
    ASSERT_FALSE(ticks.values.empty());
    ASSERT_LE(ticks.values.size(), static_cast<std::size_t>(most));
    for (const double value : ticks.values) {
      ASSERT_GE(value, range.low - 1e-8 * span);
      ASSERT_LE(value, range.high + 1e-8 * span);
    }
    if (ticks.values.size() < 2) continue;
    const double step = ticks.values[1] - ticks.values[0];
    const double mantissa = step / std::pow(10.0, std::floor(std::log10(step) + 1e-6));
    ASSERT_TRUE(std::abs(mantissa - 1) < 1e-6 || std::abs(mantissa - 2) < 1e-6 ||
                std::abs(mantissa - 5) < 1e-6)
        << step;
    // The next finer step divides this one by 2 or 2.5.
    ASSERT_GE(2.5 * static_cast<double>(ticks.values.size() + 1), most) << span;
  }
}

TEST(Ticks, OfRangesThatCannotBeDrawn) {
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(usable({inf, -inf}).low, 0.0);
  EXPECT_EQ(usable({std::nan(""), 1.0}).high, 1.0);
  EXPECT_LT(usable({5.0, 5.0}).low, 5.0);
  EXPECT_GT(usable({5.0, 5.0}).high, 5.0);
  EXPECT_GT(usable({0.0, 0.0}).span(), 0.0);
  EXPECT_GT(usable({1e15, 1e15 + 1.0}).span(), 2.0);
  for (const Range& range :
       {Range{5.0, 5.0}, Range{1e15, 1e15 + 1.0}, Range{-1e300, 1e300}, Range{-1.7e308, 1.7e308}}) {
    EXPECT_LE(nice_ticks(range, 6).values.size(), 6U);
    EXPECT_LE(nice_ticks(padded_by(usable(range), 0.5), 6).values.size(), 6U);
  }
}

TEST(Ticks, OfALogarithmicAxis) {
  EXPECT_EQ(log_ticks({0.9, 12.0}, 6).values, (std::vector<double>{1, 2, 5, 10}));
  const Ticks wide = log_ticks({0.009, 1100.0}, 6);
  ASSERT_EQ(wide.values.size(), 6U);
  EXPECT_NEAR(wide.values.front(), 0.01, 1e-12);
  EXPECT_EQ(tick_text(wide.values.front(), wide), "0.01");
  EXPECT_EQ(tick_text(wide.values.back(), wide), "1000");
  EXPECT_LE(log_ticks({1e-30, 1e30}, 6).values.size(), 6U);
}

TEST(Ticks, TextsHaveEqualDecimals) {
  const Ticks ticks = nice_ticks({-0.5, 1.0}, 4);
  EXPECT_EQ(tick_text(-0.5, ticks),
            "\xE2\x88\x92"
            "0.5");
  EXPECT_EQ(tick_text(0.0, ticks), "0.0");
  EXPECT_EQ(tick_text(2e9, nice_ticks({0.0, 4e9}, 3)), "2e+09");
  EXPECT_EQ(nice_below(437.0), 200.0);
  EXPECT_EQ(nice_below(500.0), 500.0);
  EXPECT_NEAR(nice_below(0.0999), 0.05, 1e-12);
}

}  // namespace
}  // namespace overfly::server::plot
