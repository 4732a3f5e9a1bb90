#include "core/earth/gps_time.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace overfly {
namespace {

constexpr std::int64_t kNs = 1'000'000'000;

TEST(GpsTime, BeginsIn1980) {
  EXPECT_EQ(leap_seconds_at(315'964'800 * kNs), 0);
  const GpsTime begin = gps_time_from_unix_ns(315'964'800 * kNs);
  EXPECT_EQ(begin.week, 0);
  EXPECT_EQ(begin.week_ms, 0U);
}

// The rollovers of the ten-bit week that receivers send were announced with their UTC:
// 1999-08-21T23:59:47 (week 1024) and 2019-04-06T23:59:42 (week 2048).
TEST(GpsTime, HasTheAnnouncedRollovers) {
  const GpsTime first = gps_time_from_unix_ns(935'279'987 * kNs);
  EXPECT_EQ(first.week, 1024);
  EXPECT_EQ(first.week_ms, 0U);
  const GpsTime before = gps_time_from_unix_ns(1'554'595'182 * kNs - 1'000'000);
  EXPECT_EQ(before.week, 2047);
  EXPECT_EQ(before.week_ms, 604'799'999U);
  const GpsTime second = gps_time_from_unix_ns(1'554'595'182 * kNs);
  EXPECT_EQ(second.week, 2048);
  EXPECT_EQ(second.week_ms, 0U);
}

// 2017-01-01T00:00:00Z, a Sunday: the leap second before it made GPS 18 s ahead of UTC.
TEST(GpsTime, CountsTheLatestLeapSecond) {
  constexpr std::int64_t kNewYear = 1'483'228'800;
  EXPECT_EQ(leap_seconds_at(kNewYear * kNs - 1), 17);
  EXPECT_EQ(leap_seconds_at(kNewYear * kNs), 18);
  const GpsTime time = gps_time_from_unix_ns(kNewYear * kNs + 250'000'000);
  EXPECT_EQ(time.week, 1930);
  EXPECT_EQ(time.week_ms, 18'250U);
}

TEST(GpsTime, NeverGoesBelowItsBegin) {
  EXPECT_EQ(gps_time_from_unix_ns(0).week, 0);
  EXPECT_EQ(gps_time_from_unix_ns(std::numeric_limits<std::int64_t>::min()).week_ms, 0U);
}

}  // namespace
}  // namespace overfly
