// Sensor files of a run folder: every bit comes back, in time, and damaged files are refused.
#include "server/record/rows/sensor_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "core/outside/file_text.hpp"
#include "core/time.hpp"
#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::TemporaryFolder;
using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

SensorSamples samples_at(std::int64_t t_ns) {
  const double x = 1.0 / 3.0 + s_from_ns(t_ns);
  SensorSamples samples;
  samples.imu = {{t_ns, {x, -9.81, 1e-17}, {0.1, x, -x}}};
  samples.barometer = {{t_ns, 101325.0 + x, 288.15}};
  GpsSample fix;
  fix.t_ns = t_ns;
  fix.delivered_ns = t_ns + 120'000'001;
  fix.place = geodetic_from_deg(39.3, -86.0, 200.0 + x);
  fix.velocity_ned_m_s = {20.0, x, -0.5};
  fix.horizontal_accuracy_m = 1.5;
  samples.gps = {fix};
  samples.airspeed = {{t_ns, -3.25, -std::sqrt(2.0 * 3.25 / 1.225)}};
  samples.magnetometer = {{t_ns, {19.5, -1.2, 48.0 + x}}};
  samples.range = {{t_ns, kInfinity}};
  return samples;
}

std::string error_of(const fs::path& folder) {
  Result<SensorFilesReader> reader = SensorFilesReader::open(folder);
  if (!reader) return reader.error().message;
  const Result<SensorSamples> samples = reader->until(kNsPerS);
  return samples ? "" : samples.error().message;
}

TEST(SensorFiles, EverySampleComesBackWhenItIsAvailable) {
  const TemporaryFolder folder;
  SensorFilesWriter writer(folder.path());
  ASSERT_TRUE(writer.add(samples_at(0)));
  ASSERT_TRUE(writer.add(samples_at(500'000'000)));

  SensorFilesReader reader = SensorFilesReader::open(folder.path()).value();
  const SensorSamples first = reader.until(0).value();
  const SensorSamples expected = samples_at(0);
  ASSERT_EQ(first.imu.size(), 1U);
  EXPECT_EQ(first.imu[0].acceleration_m_s2, expected.imu[0].acceleration_m_s2);
  EXPECT_EQ(first.imu[0].angular_rate_rad_s, expected.imu[0].angular_rate_rad_s);
  EXPECT_EQ(first.barometer.at(0).pressure_pa, expected.barometer[0].pressure_pa);
  EXPECT_EQ(first.barometer.at(0).temperature_k, 288.15);
  EXPECT_EQ(first.airspeed.at(0).differential_pressure_pa, -3.25);
  EXPECT_EQ(first.airspeed.at(0).indicated_airspeed_m_s,
            expected.airspeed[0].indicated_airspeed_m_s);
  EXPECT_EQ(first.magnetometer.at(0).field_ut, expected.magnetometer[0].field_ut);
  EXPECT_EQ(first.range.at(0).range_m, kInfinity);
  // The fix is still on its way.
  EXPECT_TRUE(first.gps.empty());
  EXPECT_TRUE(reader.until(120'000'000).value().empty());
  const SensorSamples late = reader.until(120'000'001).value();
  ASSERT_EQ(late.gps.size(), 1U);
  EXPECT_EQ(late.gps[0].t_ns, 0);
  EXPECT_EQ(late.gps[0].delivered_ns, 120'000'001);
  EXPECT_EQ(late.gps[0].fix, GpsFixType::k3d);
  EXPECT_NEAR(late.gps[0].place.lat_rad, expected.gps[0].place.lat_rad, 1e-15);
  EXPECT_EQ(late.gps[0].place.alt_ellipsoid_m, expected.gps[0].place.alt_ellipsoid_m);
  EXPECT_EQ(late.gps[0].velocity_ned_m_s, expected.gps[0].velocity_ned_m_s);
  EXPECT_EQ(late.gps[0].horizontal_accuracy_m, 1.5);
  EXPECT_EQ(reader.until(kNsPerS).value().imu.size(), 1U);
  EXPECT_TRUE(reader.until(2 * kNsPerS).value().empty());
}

TEST(SensorFiles, WholeNumbersHaveNoExponent) {
  const TemporaryFolder folder;
  SensorSamples samples = samples_at(0);
  samples.gps[0].delivered_ns = 100'000'000;
  SensorFilesWriter writer(folder.path());
  ASSERT_TRUE(writer.add(samples));
  const std::string text = overfly::testing::read_text(sensors_folder(folder.path()) / "gps.csv");
  EXPECT_THAT(text, HasSubstr("\n0,100000000,3,"));
}

TEST(SensorFiles, NoFixHasNoPlace) {
  const TemporaryFolder folder;
  GpsSample none;
  none.fix = GpsFixType::kNone;
  none.place = {kNan, kNan, kNan};
  none.velocity_ned_m_s.setConstant(kNan);
  SensorSamples samples;
  samples.gps = {none};
  SensorFilesWriter writer(folder.path());
  ASSERT_TRUE(writer.add(samples));
  const SensorSamples read = SensorFilesReader::open(folder.path()).value().until(0).value();
  ASSERT_EQ(read.gps.size(), 1U);
  EXPECT_EQ(read.gps[0].fix, GpsFixType::kNone);
  EXPECT_TRUE(std::isnan(read.gps[0].place.lat_rad));
}

TEST(SensorFiles, AFolderWithoutSensorsHasNoFiles) {
  const TemporaryFolder folder;
  SensorFilesWriter writer(folder.path());
  ASSERT_TRUE(writer.add({}));
  EXPECT_FALSE(fs::exists(sensors_folder(folder.path())));
  EXPECT_TRUE(SensorFilesReader::open(folder.path()).value().until(kNsPerS).value().empty());
}

TEST(SensorFiles, DamagedFilesAreRefusedWithFileAndLine) {
  const TemporaryFolder folder;
  fs::create_directories(sensors_folder(folder.path()));
  const fs::path file = sensors_folder(folder.path()) / "range.csv";
  const auto error_for = [&](const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
    return error_of(folder.path());
  };
  EXPECT_EQ(error_for("t_ns,range_m\n0,1.5\n5,2"), "") << "the truncated last line";
  EXPECT_THAT(error_for("t_ns,range\n"), HasSubstr("range.csv:1: must be \"t_ns,range_m\""));
  for (const std::string bad :
       {"0", "0,", "0,1,2", "x,1", "-1,1", "0,1x", "0;1", "", "2000000000000000000,1"}) {
    EXPECT_THAT(error_for("t_ns,range_m\n0,1\n" + bad + "\n"), HasSubstr("range.csv:3: must be a"))
        << bad;
  }
  EXPECT_THAT(error_for("t_ns,range_m\n5,1\n4,1\n"), HasSubstr("range.csv:3: must not be before"));
  EXPECT_THAT(error_for("t_ns,range_m\n" + std::string(5000, '1')),
              HasSubstr("range.csv:2: must have less than 1024"));
}

TEST(SensorFiles, AreReadInPiecesOfALimitedNumberOfSamples) {
  const TemporaryFolder folder;
  SensorFilesWriter writer(folder.path());
  for (std::int64_t i = 0; i < 5; ++i) {
    SensorSamples samples;
    samples.imu = samples_at(i).imu;
    if (i < 3) samples.range = samples_at(i).range;
    ASSERT_TRUE(writer.add(samples));
  }
  SensorFilesReader reader = SensorFilesReader::open(folder.path()).value();
  const SensorSamples first = reader.next(2).value();
  EXPECT_EQ(first.imu.size(), 2U);
  EXPECT_EQ(first.range.size(), 2U);
  const SensorSamples second = reader.next(2).value();
  EXPECT_EQ(second.imu.at(1).t_ns, 3);
  EXPECT_EQ(second.range.size(), 1U);
  EXPECT_EQ(reader.next(2).value().imu.size(), 1U);
  EXPECT_TRUE(reader.next(2).value().empty());
}

}  // namespace
}  // namespace overfly::server
