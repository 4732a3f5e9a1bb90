// Flight logs as smooth motions: recorded flights, and the files that are written of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/time.hpp"
#include "flight/replay/smooth_log.hpp"
#include "tests/flight/replay/csv_flight.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight {
namespace {

using ::testing::HasSubstr;

Result<SmoothedLog> smooth_file(const std::filesystem::path& file,
                                const smoothing::SmoothingOptions& options = {},
                                const logs::TrajectoryRequest& request = {},
                                double geoid_separation_m = 0.0) {
  const Result<logs::OpenedLog> log = logs::open_log(file);
  if (!log) return log.error();
  return smooth_log(*log, request, options, geoid_separation_m);
}

TEST(SmoothLog, KeepsPlaceAndAttitudeOfALog) {
  const testing::CsvFlight flight;
  const auto log = smooth_file(flight.mapping(), {}, {}, 20.0);
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ(log->epoch_ns, 100 * kNsPerS);
  EXPECT_EQ(log->position_source, "GPS");
  const auto poses = sampled_trajectory(*log, 10.0);
  ASSERT_TRUE(poses.ok()) << poses.error().message;
  EXPECT_EQ(poses->poses.size(), 901U);
  for (const logs::LogPose& pose : poses->poses) {
    const testing::CsvFlight::Row row = flight.row(s_from_ns(pose.t_ns));
    EXPECT_NEAR(pose.position.x(), row.lat_deg, 2e-8);
    EXPECT_NEAR(pose.position.y(), row.lon_deg, 2e-8);
    EXPECT_NEAR(pose.position.z(), row.alt_msl_m, 0.01);
    EXPECT_LT(rotation_angle_rad(pose.R_ned_body, row.R_ned_body), 1e-3);
  }
  EXPECT_FALSE(sampled_trajectory(*log, 0.0).ok());
  EXPECT_FALSE(sampled_trajectory(*log, std::nan("")).ok());
  EXPECT_FALSE(sampled_trajectory(*log, 2000.0).ok());
}

/// Attitudes that are 1.5 s early or late are needed that far outside of the slice.
TEST(SmoothLog, KeepsTheWholeSliceWithATimeOffset) {
  const testing::CsvFlight flight;
  for (const double offset_s : {-1.5, 1.5}) {
    smoothing::SmoothingOptions options;
    options.time_offset_s = offset_s;
    logs::TrajectoryRequest request;
    request.from_ns = 120 * kNsPerS;
    request.to_ns = 140 * kNsPerS;
    const auto log = smooth_file(flight.mapping(), options, request);
    ASSERT_TRUE(log.ok()) << log.error().message;
    EXPECT_NEAR(s_from_ns(log->begin_ns()), 120.0, 1e-6) << offset_s;
    EXPECT_NEAR(s_from_ns(log->end_ns()), 140.0, 1e-6) << offset_s;
  }
}

TEST(SmoothLog, WritesAResidualForEachSample) {
  const testing::CsvFlight flight(true);
  const auto log = smooth_file(flight.mapping());
  ASSERT_TRUE(log.ok()) << log.error().message;
  ASSERT_EQ(log->smoothed.jumps.size(), 1U);
  EXPECT_THAT(jump_text(*log, log->smoothed.jumps[0]),
              HasSubstr("1 position left out at 150.000 s: up to 111."));
  const overfly::testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "residuals.csv";
  ASSERT_TRUE(write_residuals(file, *log).ok());
  const std::string text = overfly::testing::read_text(file);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 451 + 1801);
  EXPECT_THAT(text, HasSubstr("\n150.000000000,position,0,0,"));
  EXPECT_THAT(text, HasSubstr("\n150.000000000,attitude,1,0,,,,"));
  EXPECT_FALSE(write_residuals(folder.path() / "absent" / "a.csv", *log).ok());
}

TEST(SmoothLog, RejectsALogWithoutTheTimeAskedFor) {
  const testing::CsvFlight flight;
  logs::TrajectoryRequest request;
  request.from_ns = 500 * kNsPerS;
  const auto log = smooth_file(flight.mapping(), {}, request);
  ASSERT_FALSE(log.ok());
  EXPECT_THAT(log.error().message, HasSubstr("no valid positions in the time asked for"));
}

/// Largest change of the acceleration from one sample of 31 Hz to the next [m/s^2].
double worst_acceleration_step(const smoothing::SmoothMotion& motion) {
  double worst = 0.0;
  for (double t_s = motion.begin_s; t_s + 0.0323 < motion.end_s; t_s += 0.0323) {
    worst = std::max(
        worst,
        (motion.position.acceleration_m_s2(t_s + 0.0323) - motion.position.acceleration_m_s2(t_s))
            .norm());
  }
  return worst;
}

TEST(RecordedSmoothLog, SmoothsTheSkywalker) {
  OVERFLY_DATA_OR_SKIP(gps, "flight_logs/skywalker_x8/TestLog2_GPS.csv");
  EXPECT_FALSE(gps.empty());
  smoothing::SmoothingOptions options;
  options.time_offset_s.reset();
  const auto log = smooth_file(
      overfly::testing::source_file("scenarios/flight_logs/skywalker_x8.mapping.json"), options);
  ASSERT_TRUE(log.ok()) << log.error().message;
  const smoothing::SmoothedMotion& smoothed = log->smoothed;
  // A receiver's own filter leaves little noise at 5 Hz. The four positions are those of its first
  // fix, on the ground.
  EXPECT_LT(smoothed.positions.rms, 0.1);
  EXPECT_EQ(smoothed.positions.left_out, 4U);
  EXPECT_EQ(smoothed.positions.shifted, 0U);
  EXPECT_LT(deg_from_rad(smoothed.attitudes.rms), 0.05);
  EXPECT_EQ(smoothed.attitudes.left_out, 0U);
  ASSERT_EQ(smoothed.jumps.size(), 1U);
  EXPECT_LT(smoothed.jumps[0].t_s, 0.1);
  // The positions arrive late: receivers of this kind need 0.2 to 0.3 s.
  ASSERT_TRUE(smoothed.estimated_offset.has_value());
  EXPECT_NEAR(smoothed.estimated_offset->offset_s, 0.266, 0.03);
  EXPECT_LT(smoothed.estimated_offset->sigma_s, 0.02);
  EXPECT_LT(worst_acceleration_step(smoothed.motion), 5.0);
}

TEST(RecordedSmoothLog, MeasuresTheDelayOfASimulatedReceiver) {
  OVERFLY_DATA_OR_SKIP(file, "sitl/plane25.BIN");
  smoothing::SmoothingOptions options;
  options.time_offset_s.reset();
  const auto offset_s = [&](const char* source) {
    logs::TrajectoryRequest request;
    request.source = source;
    const auto log = smooth_file(file, options, request);
    EXPECT_TRUE(log.ok()) << (log ? "" : log.error().message);
    EXPECT_TRUE(log->smoothed.jumps.empty());
    return log->smoothed.estimated_offset->offset_s;
  };
  // ArduPilot's simulator delays its GPS by 100 ms. The sideslip in its rolls is the same in both.
  EXPECT_NEAR(offset_s("GPS") - offset_s("SIM"), 0.1, 0.03);
}

}  // namespace
}  // namespace overfly::flight
