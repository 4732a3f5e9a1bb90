// The sensors in LCM logs and CSV files, made by hand: the known measurement with signs and units
// as the format defines them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/flight/logs/log_bytes.hpp"
#include "tests/flight/replay/known_measurement.hpp"

namespace overfly::flight::testing {
namespace {

using ::testing::HasSubstr;

/// Of the LCM log, since 1970.
constexpr std::int64_t kLogStartNs = 1'700'000'000'000'000'000;

using LoggedLcmAndCsv = LoggedFormats;

/// A message of a type with these values behind the fields that all have.
Bytes lcm_message(
    std::uint64_t fingerprint,
    std::int64_t t_ns,
    const std::vector<double>& values,
    const std::function<void(Bytes&)>& in_front = [](Bytes&) {}) {
  Bytes bytes;
  put_big(bytes, fingerprint);
  for (const std::int64_t field : {t_ns / 1000, t_ns, std::int64_t{0}, std::int64_t{1}}) {
    put_big(bytes, field);
  }
  in_front(bytes);
  for (const double value : values) put_big(bytes, value);
  return bytes;
}

TEST_F(LoggedLcmAndCsv, LcmHasTheSensorsOfItsOwnTypes) {
  Bytes bytes;
  std::int64_t number = 0;
  for (int i = 0; i < kSteps; ++i) {
    const std::int64_t t_ns = kMeasuredEveryNs * i;
    const auto event = [&](const char* channel, const Bytes& data) {
      append(bytes, lcm_event(number++, (kLogStartNs + t_ns) / 1000, channel, data));
    };
    event("A_TRUTH", lcm_truth(t_ns, {0.0, 2.5 * i, 300.0}, Eigen::Quaterniond(0, 1, 0, 0)));
    event("A_IMU",
          lcm_message(0x13b6cfa4e7f6d5d2,
                      t_ns,
                      {kRate.x(), kRate.y(), kRate.z(), kForce.x(), kForce.y(), kForce.z()}));
    event("A_BAROMETER", lcm_message(0x7474facbe707e2be, t_ns, {kPressurePa, 288.65}));
    event("A_AIRSPEED", lcm_message(0x636cd740e32eee76, t_ns, {kDynamicPa, kAirspeedMS}));
    event("A_MAGNETOMETER",
          lcm_message(0xedeb216826c4afd7, t_ns, {kFieldUt.x(), kFieldUt.y(), kFieldUt.z()}));
    event("A_RANGE",
          lcm_message(0xd7c5028f3465f922,
                      t_ns,
                      {i == 5 ? std::numeric_limits<double>::infinity() : kRangeM}));
    event("A_GPS",
          lcm_message(0x6e481370a472a917,
                      t_ns,
                      {47.0 + kLatStepDeg * i, 8.0, 547.0, 25.0, -1.0, 0.5, 1.5, 2.5, 0.25},
                      [&](Bytes& message) {
                        put_big(message, t_ns + 100'000'000);
                        message.push_back(i == 8 ? 0 : 3);
                      }));
  }
  // A cut message of a sensor.
  Bytes cut = lcm_message(0x13b6cfa4e7f6d5d2, kMeasuredEveryNs * kSteps, {1.0, 2.0});
  append(bytes, lcm_event(number++, (kLogStartNs + kMeasuredEveryNs) / 1000, "A_IMU", cut));
  LogFlightOptions options;
  options.local_origin = geodetic_from_deg(47, 8, 0);
  options.geoid_separation_m = 47.0;
  const FlownSensors flown = this->flown(bytes, options);
  ASSERT_TRUE(flown.flight);
  expect_inertial(flown.samples.imu);
  expect_field(flown.samples.magnetometer);
  expect_air(flown.samples);
  EXPECT_EQ(flown.samples.barometer[3].temperature_k, 288.65);
  ASSERT_EQ(flown.samples.range.size(), static_cast<std::size_t>(kSteps));
  EXPECT_EQ(flown.samples.range[4].range_m, kRangeM);
  EXPECT_TRUE(std::isinf(flown.samples.range[5].range_m));
  expect_fix(flown.samples.gps, 547.0);
  EXPECT_EQ(flown.samples.gps[3].velocity_ned_m_s, Eigen::Vector3d(25.0, -1.0, 0.5));
  EXPECT_EQ(flown.samples.gps[3].delivered_ns, flown.samples.gps[3].t_ns + 100'000'000);
  EXPECT_EQ(flown.samples.gps[3].speed_accuracy_m_s, 0.25);
  EXPECT_EQ(flown.samples.gps[8].fix, GpsFixType::kNone);
}

// --- CSV ---

constexpr const char* kCsvMapping = R"({"csv_mapping_version": 1, "pieces": [
  {"name": "GPS", "file": "./gps.csv", "origin": "gps",
   "time": {"column": "ms", "unit": "ms"},
   "columns": {"lat": {"column": "lat", "unit": "1e-7deg"},
               "lon": {"column": "lon", "unit": "1e-7deg"},
               "alt_msl": {"column": "alt", "unit": "m"}}},
  {"name": "IMU", "file": "./imu.csv", "origin": "estimate",
   "time": {"column": "ms", "unit": "ms"},
   "columns": {"roll": {"column": "zero", "unit": "deg"},
               "pitch": {"column": "zero", "unit": "deg"},
               "yaw": {"column": "zero", "unit": "deg"},
               "rate_x": {"column": "p", "unit": "rad/s"},
               "rate_y": {"column": "q", "unit": "deg/s"},
               "rate_z": {"column": "r", "unit": "rad/s", "scale": -1},
               "force_x": {"column": "ax", "unit": "m/s^2"},
               "force_y": {"column": "ay", "unit": "g"},
               "force_z": {"column": "az", "unit": "m/s^2"},
               "field_x": {"column": "mx", "unit": "gauss"},
               "field_y": {"column": "my", "unit": "uT"},
               "field_z": {"column": "mz", "unit": "mgauss"},
               "pressure": {"column": "hpa", "unit": "hPa"},
               "airspeed": {"column": "kmh", "unit": "km/h"},
               "range": {"column": "cm", "unit": "cm"}}}]})";

TEST_F(LoggedLcmAndCsv, CsvHasTheSensorsThatAMappingNames) {
  std::string gps = "ms,lat,lon,alt\n";
  std::string imu = "ms,zero,p,q,r,ax,ay,az,mx,my,mz,hpa,kmh,cm\n";
  for (int i = 0; i < kSteps; ++i) {
    const std::string time = std::to_string(1000 + 100 * i);
    gps += time + "," + std::to_string(470000000 + 225 * i) + ",80000000,500\n";
    imu += time + ",0,0.125,14.323944878270581,-0.5,1.5,-0.07647871597334461,-9.5,0.2,5,400,950," +
           (i == 7 ? "4000" : "90") + ",4325\n";
  }
  overfly::testing::write_text(folder_.path() / "log.json", kCsvMapping);
  overfly::testing::write_text(folder_.path() / "gps.csv", gps);
  overfly::testing::write_text(folder_.path() / "imu.csv", imu);
  LogFlightOptions options;
  options.geoid_separation_m = 47.0;
  const FlownSensors flown = sensors_of(folder_.path() / "log.json", options);
  ASSERT_TRUE(flown.flight);
  expect_inertial(flown.samples.imu);
  expect_field(flown.samples.magnetometer);
  EXPECT_EQ(flown.samples.airspeed.size(), static_cast<std::size_t>(kSteps) - 1) << "1111 m/s";
  EXPECT_NEAR(flown.samples.airspeed.at(3).indicated_airspeed_m_s, kAirspeedMS, 1e-9);
  EXPECT_NEAR(flown.samples.barometer.at(3).pressure_pa, kPressurePa, 1e-9);
  EXPECT_NEAR(flown.samples.range.at(3).range_m, kRangeM, 1e-9);
  expect_fix(flown.samples.gps, 547.0);
  EXPECT_THAT(flown.report, HasSubstr("gps from GPS (10.0 Hz)"));
}

}  // namespace
}  // namespace overfly::flight::testing
