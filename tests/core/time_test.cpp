#include "core/time.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace overfly {
namespace {

TEST(FrameTime, StampsOf31HzNeverDrift) {
  const FrameRate rate{31, 1};
  EXPECT_EQ(frame_time_ns(0, rate), 0);
  EXPECT_EQ(frame_time_ns(1, rate), 32258065);  // 32 258 064.516...
  for (std::int64_t second = 1; second < 100000; second += 997) {
    EXPECT_EQ(frame_time_ns(31 * second, rate), second * kNsPerS);
  }
}

TEST(FrameTime, FractionalRatesStayExact) {
  const FrameRate ntsc{30000, 1001};
  EXPECT_EQ(frame_time_ns(30000, ntsc), 1001 * kNsPerS);
}

TEST(FrameTime, SurvivesADayAtAThousandHertz) {
  const FrameRate rate{1000, 1};
  EXPECT_EQ(frame_time_ns(86'400'000, rate), 86'400 * kNsPerS);
}

TEST(FrameCount, CountsStampsInsideTheClosedInterval) {
  const FrameRate rate{31, 1};
  EXPECT_EQ(frame_count(0, rate), 1);
  EXPECT_EQ(frame_count(kNsPerS, rate), 32);
  EXPECT_EQ(frame_count(kNsPerS - 1, rate), 31);
  EXPECT_EQ(frame_count(-1, rate), 0);
  for (std::int64_t k = 0; k < 2000; ++k) {
    EXPECT_EQ(frame_count(frame_time_ns(k, rate), rate), k + 1);
  }
}

TEST(FrameRate, FromHzFindsTheSmallestFraction) {
  const FrameRate rate = FrameRate::from_hz(31.0).value();
  EXPECT_EQ(rate.numerator, 31);
  EXPECT_EQ(rate.denominator, 1);
  EXPECT_EQ(FrameRate::from_hz(12.5).value().numerator, 25);
  EXPECT_EQ(FrameRate::from_hz(12.5).value().denominator, 2);
}

TEST(FrameRate, RefusesRatesOutsideTheLimit) {
  EXPECT_FALSE(FrameRate::from_hz(0.0).ok());
  EXPECT_FALSE(FrameRate::from_hz(-31.0).ok());
  EXPECT_FALSE(FrameRate::from_hz(1e-9).ok());
  EXPECT_FALSE(FrameRate::from_hz(std::nan("")).ok());
  EXPECT_FALSE(FrameRate::from_hz(1e6).ok());
}

}  // namespace
}  // namespace overfly
