// What a run's sensors measured, exported and read as the log of a flight: the same samples again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/sensors/sample_source.hpp"
#include "flight/replay/logged_flight.hpp"
#include "middleware/lcm/findings.hpp"
#include "middleware/ros1/findings.hpp"
#include "server/record/rows/sensor_files.hpp"
#include "server/run/run.hpp"
#include "tests/server/export/export_fixture.hpp"

namespace overfly::server {
namespace {

using overfly::testing::TemporaryFolder;

constexpr const char* kAllSensors =
    R"(sensors={"imu":{},"barometer":{},"gps":{"delay_s":0.2},"airspeed":{},"magnetometer":{},)"
    R"("range":{"max_m":1000}})";

/// What a format keeps of a sample.
struct Kept {
  double relative = 1e-12;   ///< precision of its numbers
  bool temperature = false;  ///< of the barometer
  bool velocity = false;     ///< of the GPS, and its accuracy
  double range_relative = 0.0;
};

class SensorsAsFlights : public ::testing::Test {
 protected:
  void SetUp() override {
    RunOptions flying = testing::options_for(folder_.path() / "run");
    const auto run = run_scenario(testing::small_scenario({kAllSensors}), flying);
    ASSERT_TRUE(run.ok()) << run.error().message;
    recorded_ = SensorFilesReader::open(folder_.path() / "run").value().until(2 * kNsPerS).value();
    ASSERT_GT(recorded_.imu.size(), 300U);
    ASSERT_FALSE(recorded_.gps.empty());
  }

  /// The samples of the run, exported and flown again.
  SensorSamples flown_again(DatasetFormat format,
                            const std::string& file,
                            const std::string& truth) {
    const ExportSource source = open_export_source(folder_.path() / "run").value();
    ExportOptions options = testing::export_options(folder_.path() / file, format);
    options.renderer_factory = testing::noop_factory();
    testing::exported(source, options);
    const Geodetic origin = geodetic_from_deg(47, 8, 0);
    flight::LogFlightOptions flying;
    flying.source = truth;
    flying.local_origin = origin;
    flying.geoid_separation_m = 47.0;  // the heights of these files are above the ellipsoid
    auto flight = flight::fly_flight_log(
        options.folder / file, flying, LocalFrame(origin), FlatGround(0.0), SourcePolicy());
    EXPECT_TRUE(flight.ok()) << flight.error().message;
    if (!flight || (*flight)->sample_source() == nullptr) return {};
    return (*flight)->sample_source()->take_samples(3600 * kNsPerS);
  }

  void expect_same(const SensorSamples& read, const Kept& kept) const;

  TemporaryFolder folder_;
  SensorSamples recorded_;
};

void expect_near(double read, double recorded, double relative) {
  if (std::isinf(recorded)) {
    EXPECT_EQ(read, recorded);
  } else {
    EXPECT_NEAR(read, recorded, relative * std::abs(recorded));
  }
}

void SensorsAsFlights::expect_same(const SensorSamples& read, const Kept& kept) const {
  const auto near = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    EXPECT_LE((a - b).norm(), kept.relative * b.norm());
  };
  ASSERT_EQ(read.imu.size(), recorded_.imu.size());
  for (std::size_t i = 0; i < read.imu.size(); ++i) {
    EXPECT_EQ(read.imu[i].t_ns, recorded_.imu[i].t_ns);
    near(read.imu[i].angular_rate_rad_s, recorded_.imu[i].angular_rate_rad_s);
    near(read.imu[i].acceleration_m_s2, recorded_.imu[i].acceleration_m_s2);
  }
  ASSERT_EQ(read.barometer.size(), recorded_.barometer.size());
  for (std::size_t i = 0; i < read.barometer.size(); ++i) {
    EXPECT_EQ(read.barometer[i].t_ns, recorded_.barometer[i].t_ns);
    expect_near(read.barometer[i].pressure_pa, recorded_.barometer[i].pressure_pa, kept.relative);
    if (!kept.temperature) continue;
    expect_near(
        read.barometer[i].temperature_k, recorded_.barometer[i].temperature_k, kept.relative);
  }
  ASSERT_EQ(read.gps.size(), recorded_.gps.size());
  for (std::size_t i = 0; i < read.gps.size(); ++i) {
    const GpsSample& fix = recorded_.gps[i];
    EXPECT_EQ(read.gps[i].t_ns, fix.t_ns);
    EXPECT_EQ(read.gps[i].delivered_ns, fix.delivered_ns);
    EXPECT_EQ(read.gps[i].fix, fix.fix);
    EXPECT_NEAR(read.gps[i].place.lat_rad, fix.place.lat_rad, 1e-14);
    EXPECT_NEAR(read.gps[i].place.lon_rad, fix.place.lon_rad, 1e-14);
    EXPECT_NEAR(read.gps[i].place.alt_ellipsoid_m, fix.place.alt_ellipsoid_m, 1e-9);
    expect_near(read.gps[i].horizontal_accuracy_m, fix.horizontal_accuracy_m, kept.relative);
    expect_near(read.gps[i].vertical_accuracy_m, fix.vertical_accuracy_m, kept.relative);
    if (!kept.velocity) continue;
    EXPECT_EQ(read.gps[i].velocity_ned_m_s, fix.velocity_ned_m_s);
    EXPECT_EQ(read.gps[i].speed_accuracy_m_s, fix.speed_accuracy_m_s);
  }
  ASSERT_EQ(read.airspeed.size(), recorded_.airspeed.size());
  for (std::size_t i = 0; i < read.airspeed.size(); ++i) {
    const AirspeedSample& speed = recorded_.airspeed[i];
    EXPECT_EQ(read.airspeed[i].t_ns, speed.t_ns);
    expect_near(
        read.airspeed[i].differential_pressure_pa, speed.differential_pressure_pa, kept.relative);
    expect_near(
        read.airspeed[i].indicated_airspeed_m_s, speed.indicated_airspeed_m_s, kept.relative);
  }
  ASSERT_EQ(read.magnetometer.size(), recorded_.magnetometer.size());
  for (std::size_t i = 0; i < read.magnetometer.size(); ++i) {
    EXPECT_EQ(read.magnetometer[i].t_ns, recorded_.magnetometer[i].t_ns);
    near(read.magnetometer[i].field_ut, recorded_.magnetometer[i].field_ut);
  }
  ASSERT_EQ(read.range.size(), recorded_.range.size());
  for (std::size_t i = 0; i < read.range.size(); ++i) {
    EXPECT_EQ(read.range[i].t_ns, recorded_.range[i].t_ns);
    expect_near(read.range[i].range_m, recorded_.range[i].range_m, kept.range_relative);
  }
}

/// Of sensor_msgs/Range the range is a float32.
constexpr const char* kTruthTopic = "/camera/truth";
constexpr Kept kRos{1e-12, false, false, 1e-7};

TEST_F(SensorsAsFlights, OfMcapAreThoseOfTheRunFolder) {
  expect_same(flown_again(DatasetFormat::kMcap, "flight.mcap", kTruthTopic), kRos);
}

TEST_F(SensorsAsFlights, OfRosBagsAreThoseOfTheRunFolder) {
  if (!ros1::is_built_in()) GTEST_SKIP() << "ROS 1 is not built in";
  expect_same(flown_again(DatasetFormat::kRosbag, "flight.bag", kTruthTopic), kRos);
}

TEST_F(SensorsAsFlights, OfLcmLogsAreThoseOfTheRunFolder) {
  if (!lcm::is_built_in()) GTEST_SKIP() << "LCM is not built in";
  expect_same(flown_again(DatasetFormat::kLcm, "flight.lcm", ""), {1e-15, true, true, 0.0});
}

}  // namespace
}  // namespace overfly::server
