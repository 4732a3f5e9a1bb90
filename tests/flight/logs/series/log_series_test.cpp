// What a viewer sees of recorded logs, compared with the conversion of the same logs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "core/motion/pose.hpp"
#include "core/time.hpp"
#include "flight/logs/log_samples.hpp"
#include "flight/logs/series/log_series.hpp"
#include "flight/logs/truth/log_trajectory.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight::logs {
namespace {

class LogSeriesTest : public ::testing::TestWithParam<const char*> {};

TEST_P(LogSeriesTest, KeepsTheExtremesOfARecordedFlight) {
  OVERFLY_DATA_OR_SKIP(file, GetParam());
  const Result<OpenedLog> log = open_log(file);
  ASSERT_TRUE(log) << log.error().message;
  const Result<LogSamples> samples = read_log_samples(*log, {});
  ASSERT_TRUE(samples) << samples.error().message;
  const Result<LogSeries> series = read_log_series(*log, {"", 100});
  ASSERT_TRUE(series) << series.error().message;
  EXPECT_EQ(series->position_source, samples->position_source);
  EXPECT_EQ(series->attitude_source, samples->attitude_source);
  EXPECT_TRUE(series->georeferenced);
  EXPECT_GE(series->position_count, samples->positions.size());
  EXPECT_LE(series->positions.size(), 602U);
  EXPECT_LE(series->attitudes.size(), 602U);
  EXPECT_TRUE(series->steps.empty());

  std::map<std::int64_t, Eigen::Vector3d> logged;
  double highest_m = -1e9;
  for (const LogPosition& position : samples->positions) {
    logged[position.t_ns] = position.value;
    highest_m = std::max(highest_m, position.value.z());
  }
  double drawn_highest_m = -1e9;
  for (const SeriesPoint& point : series->positions) {
    const auto found = logged.find(point.t_ns);
    ASSERT_NE(found, logged.end());
    EXPECT_EQ(point.values[0], found->second.x());
    EXPECT_EQ(point.values[1], found->second.y());
    drawn_highest_m = std::max(drawn_highest_m, point.values[2]);
  }
  EXPECT_EQ(drawn_highest_m, highest_m);
  // The mission's airspeed is 25 m/s in wind of 0; it takes off and lands.
  double fastest_m_s = 0.0;
  for (const SeriesPoint& point : series->speeds) {
    fastest_m_s = std::max(fastest_m_s, point.values[0]);
  }
  EXPECT_GT(fastest_m_s, 24.0);
  EXPECT_LT(fastest_m_s, 40.0);
  double steepest_deg = 0.0;
  for (const SeriesPoint& point : series->attitudes) {
    steepest_deg = std::max(steepest_deg, std::abs(deg_from_rad(point.values[0])));
  }
  double logged_deg = 0.0;
  for (const LogAttitude& attitude : samples->attitudes) {
    const Eigen::Matrix3d R = attitude.R_ned_body.cast<double>().normalized().toRotationMatrix();
    logged_deg = std::max(logged_deg, std::abs(deg_from_rad(std::atan2(R(2, 1), R(2, 2)))));
  }
  // The samples hold single precision.
  EXPECT_NEAR(steepest_deg, logged_deg, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Sitl,
                         LogSeriesTest,
                         ::testing::Values("sitl/plane25.BIN", "sitl/plane25.tlog"));

/// A tlog of two runs of the clock, 5 s and 10 s, with local positions whose origin comes late.
testing::Bytes late_origin_log() {
  testing::Bytes bytes;
  std::uint8_t sequence = 0;
  const auto add = [&](std::uint32_t id, const testing::Bytes& payload) {
    testing::append(
        bytes,
        testing::tlog_record(1'700'000'000'000'000, testing::frame_bytes(id, payload, sequence++)));
  };
  for (int i = 0; i < 150; ++i) {
    const std::uint32_t boot_ms = i < 50 ? 900'000 + 100 * i : 1000 + 100 * (i - 50);
    testing::Bytes position;
    testing::put(position, boot_ms);
    for (const float value : {1.0F * i, 2.0F, -100.0F, 0.0F, 0.0F, 0.0F}) {
      testing::put(position, value);
    }
    add(30, testing::attitude_payload(boot_ms, 0.0F, 0.0F, 0.0F));
    add(32, position);
    if (i != 100) continue;
    testing::Bytes origin;
    for (const std::int32_t value : {470000000, 80000000, 400000}) testing::put(origin, value);
    add(49, origin);
  }
  return bytes;
}

TEST(LogSeries, CountsPositionsBeforeTheFirstOriginFromIt) {
  const overfly::testing::TemporaryFolder folder;
  testing::write_bytes(folder.path() / "log", late_origin_log());
  const Result<OpenedLog> log = open_log(folder.path() / "log");
  ASSERT_TRUE(log.ok()) << log.error().message;
  const Result<LogTrajectory> converted = read_log_trajectory(*log, {"LOCAL_POSITION_NED", {}, {}});
  ASSERT_TRUE(converted.ok()) << converted.error().message;
  const Result<LogSeries> series = read_log_series(*log, {"LOCAL_POSITION_NED", 1000});
  ASSERT_TRUE(series.ok()) << series.error().message;
  EXPECT_TRUE(series->georeferenced);
  EXPECT_EQ(series->vehicle, "1.1");
  EXPECT_EQ(series->run, 1U);
  ASSERT_EQ(series->positions.size(), converted->poses.size());
  for (std::size_t i = 0; i < converted->poses.size(); ++i) {
    EXPECT_EQ(series->positions[i].t_ns, converted->poses[i].t_ns);
    EXPECT_EQ(series->positions[i].values[0], converted->poses[i].position.x());
  }
}

TEST(LogSeries, TakesTheRunWithTheMostPositionsOfMany) {
  testing::Bytes bytes;
  std::uint8_t sequence = 0;
  const auto add = [&](std::uint32_t id, const testing::Bytes& payload) {
    testing::append(
        bytes,
        testing::tlog_record(1'700'000'000'000'000, testing::frame_bytes(id, payload, sequence++)));
  };
  for (int run = 0; run < 14; ++run) {
    const std::uint32_t count = run == 9 ? 80 : 40;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t boot_ms = 1000 + 100 * i;
      add(30, testing::attitude_payload(boot_ms, 0.0F, 0.0F, 0.0F));
      add(33, testing::global_position_payload(boot_ms, 470000000 + run, 80000000, 500000));
    }
  }
  const overfly::testing::TemporaryFolder folder;
  testing::write_bytes(folder.path() / "log", bytes);
  const Result<OpenedLog> log = open_log(folder.path() / "log");
  ASSERT_TRUE(log.ok()) << log.error().message;
  const Result<LogTrajectory> flown = read_log_trajectory(*log, {});
  ASSERT_TRUE(flown.ok()) << flown.error().message;
  const Result<LogSeries> series = read_log_series(*log, {"", 1000});
  ASSERT_TRUE(series.ok()) << series.error().message;
  EXPECT_EQ(flown->boot, 9U);
  EXPECT_EQ(series->run, 9U);
  EXPECT_GT(series->position_count, 70U);
}

TEST(LogSeries, ReadsASliceOfASource) {
  OVERFLY_DATA_OR_SKIP(file, "sitl/plane25.BIN");
  LogSlice slice;
  slice.from_ns = 100 * kNsPerS;
  slice.to_ns = 110 * kNsPerS;
  const Result<OpenedLog> log = open_log(file, nullptr, {.slice = slice});
  ASSERT_TRUE(log);
  const Result<LogSeries> series = read_log_series(*log, {"GPS", 1000});
  ASSERT_TRUE(series) << series.error().message;
  EXPECT_EQ(series->position_source, "GPS[0]");
  EXPECT_NEAR(static_cast<double>(series->position_count), 50.0, 3.0);
  EXPECT_GE(series->positions.front().t_ns, *slice.from_ns);
  EXPECT_LE(series->positions.back().t_ns, *slice.to_ns);
  EXPECT_FALSE(read_log_series(*log, {"NONE", 1000}));
  const std::atomic<bool> cancelled{true};
  EXPECT_EQ(read_log_series(*log, {"GPS", 1000}, &cancelled).error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace overfly::flight::logs
