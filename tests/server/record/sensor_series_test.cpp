// Curves of sensor files: names, extremes, stretches of time, errors of the GPS.
#include "server/record/rows/sensor_series.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "core/time.hpp"
#include "server/record/rows/sensor_files.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::TemporaryFolder;
using ::testing::HasSubstr;

const SensorCurves& sensor_of(const std::vector<SensorCurves>& sensors, const std::string& name) {
  for (const SensorCurves& sensor : sensors) {
    if (sensor.sensor == name) return sensor;
  }
  throw std::runtime_error("no sensor " + name);
}

const std::vector<SeriesPoint>& points_of(const std::vector<SensorCurves>& sensors,
                                          const std::string& sensor,
                                          const std::string& curve) {
  for (const SensorCurve& found : sensor_of(sensors, sensor).curves) {
    if (found.name == curve) return found.points;
  }
  throw std::runtime_error("no curve " + curve);
}

/// 100 s of an IMU at 200 Hz whose x rate has one spike, a rangefinder without echo in the second
/// half, and GPS with an outage.
void write_flight(const fs::path& folder) {
  SensorFilesWriter writer(folder);
  SensorSamples samples;
  for (std::int64_t i = 0; i < 20'000; ++i) {
    const std::int64_t t_ns = i * 5'000'000;
    const double t_s = s_from_ns(t_ns);
    samples.imu.push_back({t_ns, {0.5, 0.0, -9.81}, {i == 12'345 ? 7.0 : 0.1, std::sin(t_s), t_s}});
  }
  for (std::int64_t i = 0; i < 1000; ++i) {
    samples.range.push_back(
        {i * kNsPerS / 10, i < 500 ? 80.0 : std::numeric_limits<double>::infinity()});
  }
  for (std::int64_t i = 0; i < 500; ++i) {
    GpsSample fix;
    fix.t_ns = i * kNsPerS / 5;
    fix.delivered_ns = fix.t_ns + 100'000'000;
    fix.fix = i >= 100 && i < 200 ? GpsFixType::kNone : GpsFixType::k3d;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    fix.place = fix.fix == GpsFixType::kNone ? Geodetic{nan, nan, nan}
                                             : geodetic_from_deg(47.0, 8.0, 500.0);
    samples.gps.push_back(fix);
  }
  ASSERT_TRUE(writer.add(samples));
}

TEST(SensorSeries, KeepSpikesInBoundedMemoryAndLeaveOutWhatIsNotFinite) {
  const TemporaryFolder folder;
  write_flight(folder.path());
  SensorSeriesRequest request;
  request.max_intervals = 100;
  const auto sensors = read_sensor_series(folder.path(), request).value();
  ASSERT_EQ(sensors.size(), 3U);
  EXPECT_EQ(sensor_of(sensors, "imu").samples, 20'000U);
  const auto& rate = points_of(sensors, "imu", "wx_rad_s");
  EXPECT_LE(rate.size(), 202U);
  std::size_t spikes = 0;
  for (const SeriesPoint& point : rate) {
    if (point.values[0] == 7.0) {
      ++spikes;
      EXPECT_EQ(point.t_ns, 12'345 * 5'000'000LL);
    }
  }
  EXPECT_EQ(spikes, 1U);
  EXPECT_EQ(points_of(sensors, "imu", "fz_m_s2").front().values[0], -9.81);
  EXPECT_EQ(points_of(sensors, "imu", "wz_rad_s").back().values[0], 99.995);
  EXPECT_EQ(sensor_of(sensors, "range").samples, 1000U);
  EXPECT_EQ(points_of(sensors, "range", "range_m").back().t_ns, 499 * kNsPerS / 10);
  for (const SeriesPoint& point : points_of(sensors, "gps", "alt_ellipsoid_m")) {
    EXPECT_TRUE(point.t_ns < 20 * kNsPerS || point.t_ns >= 40 * kNsPerS);
  }
  EXPECT_EQ(sensor_of(sensors, "gps").curves.size(), 11U);
}

TEST(SensorSeries, GiveAStretchOfTimeCompletely) {
  const TemporaryFolder folder;
  write_flight(folder.path());
  SensorSeriesRequest request;
  request.from_ns = 10 * kNsPerS;
  request.to_ns = 11 * kNsPerS;
  request.max_intervals = 300;
  const auto sensors = read_sensor_series(folder.path(), request).value();
  EXPECT_EQ(sensor_of(sensors, "imu").samples, 201U);
  const auto& rate = points_of(sensors, "imu", "wy_rad_s");
  ASSERT_EQ(rate.size(), 201U);
  EXPECT_EQ(rate[0].t_ns, 10 * kNsPerS);
  EXPECT_EQ(rate[200].values[0], std::sin(11.0));
  request.from_ns = 500 * kNsPerS;
  request.to_ns = 501 * kNsPerS;
  const auto none = read_sensor_series(folder.path(), request).value();
  EXPECT_EQ(sensor_of(none, "imu").samples, 0U);
  EXPECT_TRUE(points_of(none, "imu", "wy_rad_s").empty());
}

TEST(SensorSeries, HaveErrorsOfTheGpsWhereTheyAreKnown) {
  const TemporaryFolder folder;
  write_flight(folder.path());
  SensorSeriesRequest request;
  request.gps_error = [](const GpsSample& fix) -> std::optional<Eigen::Vector3d> {
    if (fix.fix == GpsFixType::kNone || fix.t_ns > 60 * kNsPerS) return std::nullopt;
    return Eigen::Vector3d(1.0, -2.0, s_from_ns(fix.t_ns));
  };
  const auto sensors = read_sensor_series(folder.path(), request).value();
  EXPECT_EQ(points_of(sensors, "gps", "north_error_m").front().values[0], -2.0);
  const auto& up = points_of(sensors, "gps", "up_error_m");
  EXPECT_EQ(up.back().t_ns, 60 * kNsPerS);
  EXPECT_EQ(up.back().values[0], s_from_ns(60 * kNsPerS));
}

TEST(SensorSeries, NameWhatIsDamagedAndEndWhenCancelled) {
  const TemporaryFolder folder;
  EXPECT_TRUE(read_sensor_series(folder.path(), {}).value().empty());
  write_flight(folder.path());
  const std::atomic<bool> cancel{true};
  EXPECT_EQ(read_sensor_series(folder.path(), {}, &cancel).error().code, ErrorCode::kCancelled);
  // A line that is being written is not read yet.
  std::ofstream(folder.path() / "sensors" / "range.csv", std::ios::app) << "10000";
  EXPECT_TRUE(read_sensor_series(folder.path(), {}).ok());
  std::ofstream(folder.path() / "sensors" / "range.csv", std::ios::app) << ",x\n";
  const auto damaged = read_sensor_series(folder.path(), {});
  ASSERT_FALSE(damaged.ok());
  EXPECT_EQ(damaged.error().code, ErrorCode::kUnreadable);
  EXPECT_THAT(damaged.error().message, HasSubstr("range.csv:1002"));
}

}  // namespace
}  // namespace overfly::server
