// The sensors in ULog files, made by hand: the known measurement with signs and units as the format
// defines them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "tests/flight/logs/log_bytes.hpp"
#include "tests/flight/replay/known_measurement.hpp"

namespace overfly::flight::testing {
namespace {

using ::testing::HasSubstr;

using LoggedUlog = LoggedFormats;

struct UlogTopic {
  const char* definition;
  std::function<void(Bytes&, int)> fields;  ///< of a step, behind the time stamp
};

void put_floats(Bytes& bytes, const Eigen::Vector3d& values, double factor = 1.0) {
  for (const double value : values) put(bytes, static_cast<float>(factor * value));
}

const UlogTopic kUlogAttitude{"vehicle_attitude:uint64_t timestamp;float[4] q;",
                              [](Bytes& data, int) {
                                put(data, 1.0F);
                                for (int i = 0; i < 3; ++i) put(data, 0.0F);
                              }};
const UlogTopic kUlogImu{
    "sensor_combined:uint64_t timestamp;float[3] gyro_rad;uint32_t "
    "gyro_integral_dt;int32_t accelerometer_timestamp_relative;float[3] "
    "accelerometer_m_s2;uint32_t accelerometer_integral_dt;",
    [](Bytes& data, int) {
      put_floats(data, kRate);
      put(data, std::uint32_t{4000});
      put(data, std::int32_t{0});
      put_floats(data, kForce);
      put(data, std::uint32_t{4000});
    }};
const UlogTopic kUlogAir{
    "vehicle_air_data:uint64_t timestamp;uint64_t timestamp_sample;uint32_t "
    "baro_device_id;float baro_alt_meter;float baro_temp_celcius;float "
    "baro_pressure_pa;float rho;",
    [](Bytes& data, int i) {
      // Published 3 ms after it was measured.
      put(data, static_cast<std::uint64_t>(2'000'000 + 100'000 * i - 3000));
      put(data, std::uint32_t{7});
      put(data, 540.0F);
      put(data, 15.5F);
      put(data, static_cast<float>(kPressurePa));
      put(data, 1.2F);
    }};
const UlogTopic kUlogSpeed{
    "airspeed:uint64_t timestamp;float indicated_airspeed_m_s;float "
    "true_airspeed_m_s;",
    [](Bytes& data, int) {
      put(data, 25.0F);
      put(data, 26.0F);
    }};
const UlogTopic kUlogField{"vehicle_magnetometer:uint64_t timestamp;float[3] magnetometer_ga;",
                           [](Bytes& data, int) { put_floats(data, kFieldUt, 0.01); }};
const UlogTopic kUlogDistance{
    "distance_sensor:uint64_t timestamp;float min_distance;float "
    "max_distance;float current_distance;int8_t signal_quality;uint8_t "
    "orientation;",
    [](Bytes& data, int i) {
      put(data, 0.5F);
      put(data, 50.0F);
      put(data, i == 5 ? 50.0F : static_cast<float>(kRangeM));
      data.push_back(i == 6 ? 0 : 90);  // without a signal
      data.push_back(i == 7 ? 0 : 25);  // forwards
    }};
const UlogTopic kUlogFix{
    "vehicle_gps_position:uint64_t timestamp;int32_t lat;int32_t lon;int32_t alt;int32_t "
    "alt_ellipsoid;float s_variance_m_s;uint8_t fix_type;float eph;float epv;float "
    "vel_n_m_s;float vel_e_m_s;float vel_d_m_s;bool vel_ned_valid;",
    [](Bytes& data, int i) {
      put(data, 470000000 + 225 * i);
      put(data, std::int32_t{80000000});
      put(data, std::int32_t{500000});
      put(data, std::int32_t{547000});
      put(data, 0.25F);
      data.push_back(i == 8 ? 2 : 3);
      put(data, 1.5F);
      put(data, 2.5F);
      put_floats(data, {25.0, -1.0, 0.5});
      data.push_back(i == 9 ? 0 : 1);
    }};

Bytes px4_log_of(const std::vector<UlogTopic>& topics) {
  Bytes bytes = ulog_header();
  for (const UlogTopic& topic : topics) append(bytes, ulog_text('F', topic.definition));
  std::uint16_t id = 0;
  for (const UlogTopic& topic : topics) {
    const std::string text = topic.definition;
    append(bytes, ulog_subscription(0, id++, text.substr(0, text.find(':'))));
  }
  for (int i = 0; i < kSteps; ++i) {
    for (id = 0; id < topics.size(); ++id) {
      Bytes data;
      put(data, static_cast<std::uint64_t>(2'000'000 + 100'000 * i));
      topics[id].fields(data, i);
      append(bytes, ulog_data(id, data));
    }
  }
  return bytes;
}

TEST_F(LoggedUlog, UlogHasTheSensorsOfPx4) {
  LogFlightOptions options;
  options.geoid_separation_m = 47.0;
  const FlownSensors flown = this->flown(
      px4_log_of(
          {kUlogAttitude, kUlogFix, kUlogImu, kUlogAir, kUlogSpeed, kUlogField, kUlogDistance}),
      options);
  ASSERT_TRUE(flown.flight);
  const SensorSamples& samples = flown.samples;
  // The first one's middle lies before the flight's begin.
  ASSERT_EQ(samples.imu.size(), static_cast<std::size_t>(kSteps) - 1);
  EXPECT_EQ(samples.imu[0].t_ns, kMeasuredEveryNs - 2'000'000);
  EXPECT_EQ(samples.imu[0].interval_ns, 4'000'000);
  EXPECT_EQ(available_ns(samples.imu[0]), kMeasuredEveryNs);
  EXPECT_EQ(samples.imu[0].angular_rate_rad_s, kRate);
  EXPECT_EQ(samples.imu[0].acceleration_m_s2, kForce);
  ASSERT_EQ(samples.barometer.size(), static_cast<std::size_t>(kSteps) - 1);
  EXPECT_EQ(samples.barometer[0].t_ns, kMeasuredEveryNs - 3'000'000);
  EXPECT_EQ(samples.barometer[0].pressure_pa, kPressurePa);
  EXPECT_NEAR(samples.barometer[0].temperature_k, 288.65, 1e-9);
  EXPECT_NEAR(samples.airspeed.at(3).differential_pressure_pa, kDynamicPa, 1e-3);
  expect_field(samples.magnetometer);
  ASSERT_EQ(samples.range.size(), static_cast<std::size_t>(kSteps) - 1) << "one looks forwards";
  EXPECT_EQ(samples.range[4].range_m, kRangeM);
  EXPECT_TRUE(std::isinf(samples.range[5].range_m)) << "at the sensor's limit";
  EXPECT_TRUE(std::isinf(samples.range[6].range_m)) << "without a signal";
  expect_fix(samples.gps, 547.0);
  EXPECT_EQ(samples.gps[3].velocity_ned_m_s, Eigen::Vector3d(25.0, -1.0, 0.5));
  EXPECT_EQ(samples.gps[3].horizontal_accuracy_m, 1.5);
  EXPECT_EQ(samples.gps[3].vertical_accuracy_m, 2.5);
  EXPECT_EQ(samples.gps[3].speed_accuracy_m_s, 0.25);
  EXPECT_EQ(samples.gps[8].fix, GpsFixType::kNone);
  EXPECT_TRUE(std::isnan(samples.gps[8].place.lat_rad));
  EXPECT_TRUE(samples.gps[9].velocity_ned_m_s.hasNaN());
  EXPECT_THAT(flown.report, HasSubstr("imu from sensor_combined[0] (10.0 Hz)"));
}

TEST_F(LoggedUlog, UlogOfOtherVersionsHasTheSameSensors) {
  const UlogTopic imu{
      "sensor_combined:uint64_t timestamp;float[3] gyro_rad;float "
      "gyro_integral_dt;int32_t accelerometer_timestamp_relative;float[3] "
      "accelerometer_m_s2;",
      [](Bytes& data, int i) {
        put_floats(data, kRate);
        put(data, 0.004F);
        put(data, std::int32_t{i == 4 ? 0x7FFFFFFF : 0});
        put_floats(data, kForce);
      }};
  const auto barometer = [](float pressure) {
    return UlogTopic{
        "sensor_baro:uint64_t timestamp;uint32_t device_id;float pressure;float "
        "temperature;",
        [pressure](Bytes& data, int i) {
          put(data, std::uint32_t{7});
          put(data, i == 2 ? std::numeric_limits<float>::quiet_NaN() : pressure);
          put(data, 15.5F);
        }};
  };
  const UlogTopic fix{
      "sensor_gps:uint64_t timestamp;uint64_t timestamp_sample;double "
      "latitude_deg;double longitude_deg;double altitude_msl_m;double "
      "altitude_ellipsoid_m;uint8_t fix_type;",
      [](Bytes& data, int i) {
        put(data, static_cast<std::uint64_t>(2'000'000 + 100'000 * i - 80'000));
        for (const double value : {47.0 + kLatStepDeg * i, 8.0, 500.0, 547.0}) {
          put(data, value);
        }
        data.push_back(6);
      }};
  const UlogTopic field{"sensor_mag:uint64_t timestamp;float x;float y;float z;",
                        [](Bytes& data, int) { put_floats(data, kFieldUt, 0.01); }};
  for (const float pressure : {950.0F, 95000.0F}) {
    const FlownSensors flown =
        this->flown(px4_log_of({kUlogAttitude, fix, imu, barometer(pressure), field}));
    ASSERT_TRUE(flown.flight);
    EXPECT_EQ(flown.samples.imu.size(), static_cast<std::size_t>(kSteps) - 2);
    EXPECT_EQ(flown.samples.imu.at(0).interval_ns, 4'000'000);
    // The flight begins when the first fix with attitudes on both sides was measured, 20 ms after
    // the first messages.
    EXPECT_EQ(flown.samples.barometer.size(), static_cast<std::size_t>(kSteps) - 2);
    EXPECT_EQ(flown.samples.barometer.at(0).pressure_pa, kPressurePa);
    ASSERT_EQ(flown.samples.magnetometer.size(), static_cast<std::size_t>(kSteps) - 1);
    EXPECT_EQ(flown.samples.magnetometer[0].t_ns, kMeasuredEveryNs - 20'000'000);
    EXPECT_LT((flown.samples.magnetometer[0].field_ut - kFieldUt).norm(), 1e-5);
    ASSERT_EQ(flown.samples.gps.size(), static_cast<std::size_t>(kSteps) - 1);
    EXPECT_EQ(flown.samples.gps[0].t_ns, 0);
    EXPECT_EQ(flown.samples.gps[0].delivered_ns, 80'000'000);
    EXPECT_TRUE(std::isnan(flown.samples.gps[0].horizontal_accuracy_m));
    EXPECT_THAT(flown.report, HasSubstr("2 messages had no value that can be right"));
  }
}

}  // namespace
}  // namespace overfly::flight::testing
