// Curves of sensor files: names, extremes, stretches of time, errors of the GPS.
#include "server/record/rows/sensor_series.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
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

/// Without an index from before.
Result<std::vector<SensorCurves>> all_read(const fs::path& folder,
                                           const SensorSeriesRequest& request,
                                           const std::atomic<bool>* cancel = nullptr) {
  SensorIndex index;
  auto series = read_sensor_series(folder, request, index, cancel);
  if (!series) return series.error();
  return std::move(series->sensors);
}

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
  const auto sensors = all_read(folder.path(), request).value();
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
  const auto sensors = all_read(folder.path(), request).value();
  EXPECT_EQ(sensor_of(sensors, "imu").samples, 201U);
  const auto& rate = points_of(sensors, "imu", "wy_rad_s");
  ASSERT_EQ(rate.size(), 201U);
  EXPECT_EQ(rate[0].t_ns, 10 * kNsPerS);
  EXPECT_EQ(rate[200].values[0], std::sin(11.0));
  request.from_ns = 500 * kNsPerS;
  request.to_ns = 501 * kNsPerS;
  const auto none = all_read(folder.path(), request).value();
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
  const auto sensors = all_read(folder.path(), request).value();
  EXPECT_EQ(points_of(sensors, "gps", "north_error_m").front().values[0], -2.0);
  const auto& up = points_of(sensors, "gps", "up_error_m");
  EXPECT_EQ(up.back().t_ns, 60 * kNsPerS);
  EXPECT_EQ(up.back().values[0], s_from_ns(60 * kNsPerS));
}

TEST(SensorSeries, NameWhatIsDamagedAndEndWhenCancelled) {
  const TemporaryFolder folder;
  EXPECT_TRUE(all_read(folder.path(), {}).value().empty());
  write_flight(folder.path());
  const std::atomic<bool> cancel{true};
  EXPECT_EQ(all_read(folder.path(), {}, &cancel).error().code, ErrorCode::kCancelled);
  // A line that is being written is not read yet.
  std::ofstream(folder.path() / "sensors" / "range.csv", std::ios::app) << "10000";
  EXPECT_TRUE(all_read(folder.path(), {}).ok());
  std::ofstream(folder.path() / "sensors" / "range.csv", std::ios::app) << ",x\n";
  const auto damaged = all_read(folder.path(), {});
  ASSERT_FALSE(damaged.ok());
  EXPECT_EQ(damaged.error().code, ErrorCode::kUnreadable);
  EXPECT_THAT(damaged.error().message, HasSubstr("range.csv:1002"));
}

void expect_equal(const std::vector<SensorCurves>& a, const std::vector<SensorCurves>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].sensor, b[i].sensor);
    EXPECT_EQ(a[i].samples, b[i].samples);
    ASSERT_EQ(a[i].curves.size(), b[i].curves.size());
    for (std::size_t c = 0; c < a[i].curves.size(); ++c) {
      EXPECT_EQ(a[i].curves[c].name, b[i].curves[c].name);
      const auto& points_a = a[i].curves[c].points;
      const auto& points_b = b[i].curves[c].points;
      ASSERT_EQ(points_a.size(), points_b.size());
      for (std::size_t p = 0; p < points_a.size(); ++p) {
        ASSERT_EQ(points_a[p].t_ns, points_b[p].t_ns);
        ASSERT_EQ(points_a[p].values[0], points_b[p].values[0]);
      }
    }
  }
}

std::uint64_t bytes_of_files(const fs::path& folder) {
  std::uint64_t bytes = 0;
  for (const auto& file : fs::directory_iterator(folder / "sensors")) bytes += file.file_size();
  return bytes;
}

SensorSeriesRequest stretch_of(double from_s, double to_s) {
  SensorSeriesRequest request;
  request.from_ns = ns_from_s(from_s);
  request.to_ns = ns_from_s(to_s);
  return request;
}

TEST(SensorSeries, ReadOnlyTheStretchOnceTheFilesAreKnown) {
  const TemporaryFolder folder;
  write_flight(folder.path());
  const std::uint64_t all_bytes = bytes_of_files(folder.path());
  ASSERT_GT(all_bytes, 1'000'000U);
  SensorIndex index;
  const auto first = read_sensor_series(folder.path(), stretch_of(90.0, 91.0), index);
  ASSERT_TRUE(first.ok());
  // The header is looked at before the rows: up to 1 KiB of each of three files.
  EXPECT_GE(first->bytes_read, all_bytes);
  EXPECT_LE(first->bytes_read, all_bytes + 3 * 1024);
  expect_equal(first->sensors, all_read(folder.path(), stretch_of(90.0, 91.0)).value());
  for (const auto& [from_s, to_s] : {std::pair(90.0, 91.0),
                                     std::pair(0.0, 0.5),
                                     std::pair(19.9, 20.3),
                                     std::pair(99.0, 200.0),
                                     std::pair(500.0, 501.0)}) {
    const auto again = read_sensor_series(folder.path(), stretch_of(from_s, to_s), index);
    ASSERT_TRUE(again.ok()) << again.error().message;
    // At most three blocks of 64 KiB of each file, and the longest row.
    EXPECT_LE(again->bytes_read, 3U * (3 * 65536 + 1024)) << from_s;
    EXPECT_LT(again->bytes_read, all_bytes / 4) << from_s;
    expect_equal(again->sensors, all_read(folder.path(), stretch_of(from_s, to_s)).value());
  }
  const auto whole = read_sensor_series(folder.path(), {}, index);
  ASSERT_TRUE(whole.ok());
  expect_equal(whole->sensors, all_read(folder.path(), {}).value());
}

TEST(SensorSeries, AreExtendedWhileTheFilesGrow) {
  const TemporaryFolder folder;
  SensorFilesWriter writer(folder.path());
  SensorIndex index;
  std::int64_t next = 0;
  for (int piece = 0; piece < 20; ++piece) {
    SensorSamples samples;
    for (int i = 0; i < 2000; ++i, ++next) {
      const double value = static_cast<double>(next % 977);
      samples.imu.push_back({next * 5'000'000, {value, 0.25, -9.81}, {0.1, value, 0.3}});
    }
    ASSERT_TRUE(writer.add(samples));
    const double end_s = s_from_ns(next * 5'000'000);
    const auto series = read_sensor_series(folder.path(), stretch_of(end_s - 2.0, end_s), index);
    ASSERT_TRUE(series.ok());
    EXPECT_EQ(series->sensors.at(0).samples, 400U);
    // What is new, about 60 KB, and at most two blocks that were known.
    EXPECT_LE(series->bytes_read, 3U * 65536) << piece;
    expect_equal(series->sensors, all_read(folder.path(), stretch_of(end_s - 2.0, end_s)).value());
    const auto early = read_sensor_series(folder.path(), stretch_of(1.0, 2.0), index);
    ASSERT_TRUE(early.ok());
    EXPECT_EQ(early->sensors.at(0).samples, 201U);
    EXPECT_LE(early->bytes_read, 2U * 65536);
  }
}

TEST(SensorSeries, AreReadAgainWhenTheFileIsAnother) {
  const TemporaryFolder folder;
  write_flight(folder.path());
  SensorIndex index;
  ASSERT_TRUE(read_sensor_series(folder.path(), {}, index).ok());
  const fs::path file = folder.path() / "sensors" / "range.csv";
  // Another file in its place, and one of the same size that was written over it.
  const std::string header = "t_ns,range_m\n";
  overfly::testing::write_text(folder.path() / "other", header + "5000000000,1\n");
  fs::rename(folder.path() / "other", file);
  const auto other = read_sensor_series(folder.path(), stretch_of(4.0, 6.0), index);
  ASSERT_TRUE(other.ok()) << other.error().message;
  EXPECT_EQ(points_of(other->sensors, "range", "range_m").size(), 1U);
  std::ofstream(file, std::ios::in) << header << "5500000000,2\n";
  fs::last_write_time(file, fs::last_write_time(file) + std::chrono::seconds(5));
  const auto over = read_sensor_series(folder.path(), stretch_of(5.2, 6.0), index);
  ASSERT_TRUE(over.ok());
  ASSERT_EQ(points_of(over->sensors, "range", "range_m").size(), 1U);
  EXPECT_EQ(points_of(over->sensors, "range", "range_m")[0].values[0], 2.0);
  // Longer, but not the file that it was.
  std::ofstream(file, std::ios::in) << header << "x\n1,1\n2,2\n3,3\n4,4\n";
  EXPECT_FALSE(read_sensor_series(folder.path(), stretch_of(5.2, 6.0), index).ok());
  overfly::testing::write_text(file, header + "1,1\n");
  const auto shorter = read_sensor_series(folder.path(), {}, index);
  ASSERT_TRUE(shorter.ok()) << shorter.error().message;
  EXPECT_EQ(sensor_of(shorter->sensors, "range").samples, 1U);
  fs::remove(file);
  EXPECT_EQ(read_sensor_series(folder.path(), {}, index)->sensors.size(), 2U);
}

TEST(SensorFileIndex, StaysBoundedAndFindsWhatIsOutOfOrder) {
  SensorFileIndex index;
  index.start({10, 1, 0});
  constexpr std::uint64_t kRowBytes = 10'000;
  constexpr std::uint64_t kRows = 300'000;
  for (std::uint64_t i = 0; i < kRows; ++i) {
    // Every hundredth was measured 1000 steps before it was delivered.
    const auto t_ns = static_cast<std::int64_t>(i) - (i % 100 == 0 && i >= 1000 ? 1000 : 0);
    index.add(t_ns, {10 + (i + 1) * kRowBytes, static_cast<std::int64_t>(i) + 2, 0});
  }
  EXPECT_LE(index.size(), SensorFileIndex::kMaxBlocks);
  EXPECT_GT(index.size(), SensorFileIndex::kMaxBlocks / 4);
  EXPECT_EQ(index.end().offset, 10 + kRows * kRowBytes);
  const auto found = index.stretches(150'000, 150'010);
  const auto holds = [&](std::uint64_t row) {
    return std::any_of(found.begin(), found.end(), [&](const SensorBlock& block) {
      return block.begin.offset <= 10 + row * kRowBytes && block.end >= 10 + (row + 1) * kRowBytes;
    });
  };
  for (const std::uint64_t row : {150'001U, 150'010U, 151'000U}) EXPECT_TRUE(holds(row)) << row;
  EXPECT_FALSE(holds(140'000));
  EXPECT_FALSE(holds(160'000));
  EXPECT_TRUE(index.stretches(-5, -1).empty());
  ASSERT_EQ(index.stretches(0, 400'000).size(), 1U);
  EXPECT_EQ(index.stretches(0, 400'000)[0].begin.offset, 10U);
}

TEST(SensorIndexShelf, KeepsTheRunsThatWereReadLast) {
  SensorIndexShelf shelf;
  const auto first = shelf.of("/runs/0");
  for (std::size_t i = 1; i < SensorIndexShelf::kMaxRuns; ++i) {
    (void)shelf.of("/runs/" + std::to_string(i));
  }
  EXPECT_EQ(shelf.of("/runs/0"), first);
  (void)shelf.of("/runs/another");
  EXPECT_EQ(shelf.of("/runs/0"), first);
  for (std::size_t i = 0; i < SensorIndexShelf::kMaxRuns; ++i) {
    (void)shelf.of("/more/" + std::to_string(i));
  }
  EXPECT_NE(shelf.of("/runs/0"), first);
}

}  // namespace
}  // namespace overfly::server
