// The sensors in logs of each format, made by hand: one measurement in all of them, with signs and
// units as the formats define them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/time.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/flight/logs/ros_bytes.hpp"
#include "tests/flight/replay/flown_sensors.hpp"
#include "tests/support/support.hpp"

namespace overfly::flight {
namespace {

using testing::append;
using testing::Bytes;
using testing::FlownSensors;
using ::testing::HasSubstr;
using testing::put;
using testing::put_big;
using testing::sensors_of;
using testing::Wire;
using testing::WireWriter;

// An aircraft that rolls to the right, raises its nose and turns to the right, in a field that
// points north-east-down of it: all in body axes forward-right-down.
const Eigen::Vector3d kRate(0.125, 0.25, 0.5);
const Eigen::Vector3d kForce(1.5, -0.75, -9.5);
const Eigen::Vector3d kFieldUt(20.0, 5.0, 40.0);
constexpr double kPressurePa = 95000.0;
constexpr double kAirspeedMS = 25.0;
constexpr double kDynamicPa = 0.5 * 1.225 * 25.0 * 25.0;
constexpr double kRangeM = 43.25;
constexpr int kSteps = 20;
constexpr std::int64_t kMeasuredEveryNs = 100'000'000;
constexpr double kLatStepDeg = 2.25e-5;  // 25 m/s

/// @param samples  one of each step
void expect_inertial(const std::vector<ImuSample>& samples, std::int64_t first_ns = 0) {
  ASSERT_EQ(samples.size(), static_cast<std::size_t>(kSteps));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].t_ns, first_ns + static_cast<std::int64_t>(i) * kMeasuredEveryNs);
    EXPECT_LT((samples[i].angular_rate_rad_s - kRate).norm(), 1e-7);
    EXPECT_LT((samples[i].acceleration_m_s2 - kForce).norm(), 1e-6);
  }
}

void expect_field(const std::vector<MagnetometerSample>& samples) {
  ASSERT_EQ(samples.size(), static_cast<std::size_t>(kSteps));
  EXPECT_EQ(samples[3].t_ns, 3 * kMeasuredEveryNs);
  EXPECT_LT((samples[3].field_ut - kFieldUt).norm(), 1e-5);
}

void expect_air(const SensorSamples& samples) {
  ASSERT_EQ(samples.barometer.size(), static_cast<std::size_t>(kSteps));
  EXPECT_EQ(samples.barometer[3].t_ns, 3 * kMeasuredEveryNs);
  EXPECT_NEAR(samples.barometer[3].pressure_pa, kPressurePa, 0.01);
  ASSERT_EQ(samples.airspeed.size(), static_cast<std::size_t>(kSteps));
  EXPECT_NEAR(samples.airspeed[3].indicated_airspeed_m_s, kAirspeedMS, 1e-5);
  EXPECT_NEAR(samples.airspeed[3].differential_pressure_pa, kDynamicPa, 1e-3);
}

void expect_fix(const std::vector<GpsSample>& samples, double alt_ellipsoid_m) {
  ASSERT_EQ(samples.size(), static_cast<std::size_t>(kSteps));
  EXPECT_EQ(samples[0].fix, GpsFixType::k3d);
  EXPECT_EQ(samples[3].t_ns, 3 * kMeasuredEveryNs);
  EXPECT_NEAR(deg_from_rad(samples[3].place.lat_rad), 47.0 + 3 * kLatStepDeg, 1e-7);
  EXPECT_NEAR(deg_from_rad(samples[3].place.lon_rad), 8.0, 1e-7);
  EXPECT_NEAR(samples[3].place.alt_ellipsoid_m, alt_ellipsoid_m, 1e-3);
}

// --- ULog ---

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
  Bytes bytes = testing::ulog_header();
  for (const UlogTopic& topic : topics) append(bytes, testing::ulog_text('F', topic.definition));
  std::uint16_t id = 0;
  for (const UlogTopic& topic : topics) {
    const std::string text = topic.definition;
    append(bytes, testing::ulog_subscription(0, id++, text.substr(0, text.find(':'))));
  }
  for (int i = 0; i < kSteps; ++i) {
    for (id = 0; id < topics.size(); ++id) {
      Bytes data;
      put(data, static_cast<std::uint64_t>(2'000'000 + 100'000 * i));
      topics[id].fields(data, i);
      append(bytes, testing::ulog_data(id, data));
    }
  }
  return bytes;
}

class LoggedFormats : public ::testing::Test {
 protected:
  [[nodiscard]] FlownSensors flown(const Bytes& bytes, const LogFlightOptions& options = {}) {
    const auto file = folder_.path() / ("flight" + std::to_string(files_++));
    testing::write_bytes(file, bytes);
    return sensors_of(file, options);
  }
  overfly::testing::TemporaryFolder folder_;
  int files_ = 0;
};

TEST_F(LoggedFormats, UlogHasTheSensorsOfPx4) {
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

TEST_F(LoggedFormats, UlogOfOtherVersionsHasTheSameSensors) {
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
    EXPECT_EQ(flown.samples.barometer.size(), static_cast<std::size_t>(kSteps) - 1);
    EXPECT_EQ(flown.samples.barometer.at(0).pressure_pa, kPressurePa);
    expect_field(flown.samples.magnetometer);
    ASSERT_EQ(flown.samples.gps.size(), static_cast<std::size_t>(kSteps) - 1);
    EXPECT_EQ(flown.samples.gps[0].t_ns, kMeasuredEveryNs - 80'000'000);
    EXPECT_EQ(flown.samples.gps[0].delivered_ns, kMeasuredEveryNs);
    EXPECT_TRUE(std::isnan(flown.samples.gps[0].horizontal_accuracy_m));
    EXPECT_THAT(flown.report, HasSubstr("2 messages had no value that can be right"));
  }
}

// --- ROS ---

struct RosTopic {
  std::string name;
  std::string package;
  std::string type;
  std::function<Bytes(Wire, std::int64_t stamp_ns, int)> message;
};

constexpr std::int64_t kRosStartNs = 1'700'000'000'000'000'000;

/// Forward-left-up.
Eigen::Vector3d flu(const Eigen::Vector3d& frd) { return {frd.x(), -frd.y(), -frd.z()}; }

Bytes imu_bytes(Wire wire,
                std::int64_t stamp_ns,
                const Eigen::Vector3d& rate,
                const Eigen::Vector3d& force,
                double force_covariance,
                std::string_view frame) {
  WireWriter message(wire);
  message.header(stamp_ns, frame).quaternion(Eigen::Quaterniond::Identity()).zeros(9);
  message.vector(rate).zeros(9).vector(force).number(force_covariance);
  return message.zeros(8).bytes();
}

Bytes fix_bytes(Wire wire, std::int64_t stamp_ns, int i) {
  WireWriter message(wire);
  message.header(stamp_ns, "gps").number(std::int8_t{0}).number(std::uint16_t{1});
  message.vector({47.0 + kLatStepDeg * i, 8.0, 547.0});
  // East, north, up.
  for (const double variance : {2.25, 0.0, 0.0, 0.0, 2.25, 0.0, 0.0, 0.0, 6.25}) {
    message.number(variance);
  }
  return message.number(std::uint8_t{2}).bytes();
}

RosTopic pressure_topic(const std::string& name, double pressure_pa) {
  return {name, "sensor_msgs", "FluidPressure", [=](Wire wire, std::int64_t stamp_ns, int) {
            WireWriter message(wire);
            return message.header(stamp_ns, "base_link").number(pressure_pa).zeros(1).bytes();
          }};
}

std::vector<RosTopic> ros_topics() {
  return {
      {"/imu/data",
       "sensor_msgs",
       "Imu",
       [](Wire wire, std::int64_t stamp_ns, int) {
         // As of an estimator: its angular rate is another one.
         return imu_bytes(wire, stamp_ns, {9, 9, 9}, flu(kForce), 0.0, "base_link");
       }},
      {"/imu/data_raw",
       "sensor_msgs",
       "Imu",
       [](Wire wire, std::int64_t stamp_ns, int) {
         return imu_bytes(wire, stamp_ns, flu(kRate), flu(kForce), 0.0, "base_link");
       }},
      {"/gps/fix", "sensor_msgs", "NavSatFix", fix_bytes},
      {"/imu/mag",
       "sensor_msgs",
       "MagneticField",
       [](Wire wire, std::int64_t stamp_ns, int) {
         WireWriter message(wire);
         return message.header(stamp_ns, "").vector(1e-6 * flu(kFieldUt)).zeros(9).bytes();
       }},
      pressure_topic("/imu/static_pressure", kPressurePa),
      pressure_topic("/imu/diff_pressure", kDynamicPa),
      {"/range",
       "sensor_msgs",
       "Range",
       [](Wire wire, std::int64_t stamp_ns, int i) {
         constexpr float kInfinity = std::numeric_limits<float>::infinity();
         WireWriter message(wire);
         message.header(stamp_ns, "range_link").number(std::uint8_t{1}).number(0.1F);
         message.number(0.5F).number(50.0F);
         const float range = i == 5   ? kInfinity
                             : i == 6 ? -kInfinity
                             : i == 7 ? std::numeric_limits<float>::quiet_NaN()
                                      : static_cast<float>(kRangeM);
         return message.number(range).bytes();
       }},
  };
}

/// Each message is recorded 30 ms after its stamp.
Bytes recording_of(const std::vector<RosTopic>& topics, Wire wire, bool bag) {
  Bytes bytes = bag ? testing::bag_start(0) : testing::mcap_start("");
  const std::string between = wire == Wire::kRos1 ? "/" : "/msg/";
  std::uint16_t id = 1;
  for (const RosTopic& topic : topics) {
    const std::string type = topic.package + between + topic.type;
    if (bag) {
      append(bytes, testing::bag_connection(id, topic.name, type));
    } else {
      append(bytes, testing::mcap_schema(id, type));
      const char* const encoding = wire == Wire::kRos1 ? "ros1" : "cdr";
      append(bytes, testing::mcap_channel(id, id, topic.name, encoding));
    }
    ++id;
  }
  for (int i = 0; i < kSteps; ++i) {
    id = 1;
    for (const RosTopic& topic : topics) {
      const std::int64_t stamp_ns = kRosStartNs + kMeasuredEveryNs * i;
      const std::int64_t recorded_ns = stamp_ns + 30'000'000;
      const Bytes data = topic.message(wire, stamp_ns, i);
      append(bytes,
             bag ? testing::bag_message(id, recorded_ns, data)
                 : testing::mcap_message(id, static_cast<std::uint64_t>(recorded_ns), data));
      ++id;
    }
  }
  if (!bag) append(bytes, testing::mcap_end());
  return bytes;
}

void expect_all_of_ros(const FlownSensors& flown) {
  ASSERT_TRUE(flown.flight);
  const SensorSamples& samples = flown.samples;
  expect_inertial(samples.imu);
  expect_field(samples.magnetometer);
  expect_air(samples);
  EXPECT_TRUE(std::isnan(samples.barometer[3].temperature_k));
  // Too near, and not a number, are no samples.
  ASSERT_EQ(samples.range.size(), static_cast<std::size_t>(kSteps) - 2);
  EXPECT_EQ(samples.range[4].range_m, kRangeM);
  EXPECT_TRUE(std::isinf(samples.range[5].range_m));
  expect_fix(samples.gps, 547.0);
  EXPECT_EQ(samples.gps[3].delivered_ns, samples.gps[3].t_ns + 30'000'000);
  EXPECT_NEAR(samples.gps[3].horizontal_accuracy_m, 1.5, 1e-12);
  EXPECT_NEAR(samples.gps[3].vertical_accuracy_m, 2.5, 1e-12);
  EXPECT_THAT(flown.report, HasSubstr("imu from /imu/data_raw (10.0 Hz)"));
  EXPECT_THAT(flown.report, HasSubstr("airspeed from /imu/diff_pressure"));
  EXPECT_THAT(flown.report, HasSubstr("2 messages had no value that can be right"));
}

TEST_F(LoggedFormats, RosBagsHaveTheirSensorsInBodyAxes) {
  expect_all_of_ros(flown(recording_of(ros_topics(), Wire::kRos1, true)));
}

TEST_F(LoggedFormats, McapHasTheSensorsOfBothVersionsOfRos) {
  for (const Wire wire : {Wire::kRos1, Wire::kCdrLittle, Wire::kCdrBig}) {
    expect_all_of_ros(flown(recording_of(ros_topics(), wire, false)));
  }
}

TEST_F(LoggedFormats, RosImuIsLeftOutWithoutAccelerationsAndOfTruth) {
  std::vector<RosTopic> topics = ros_topics();
  topics.resize(3);
  // As MAVROS marks what it has not received.
  topics[1].message = [](Wire wire, std::int64_t stamp_ns, int) {
    return imu_bytes(wire, stamp_ns, flu(kRate), {0, 0, 0}, -1.0, "base_link");
  };
  FlownSensors without = flown(recording_of(topics, Wire::kRos1, true));
  ASSERT_TRUE(without.flight);
  EXPECT_THAT(without.report, HasSubstr("imu from /imu/data ("));
  EXPECT_THAT(without.report, HasSubstr("20 messages had no value that can be right"));

  topics[0].name = "/truth/imu";
  without = flown(recording_of(topics, Wire::kRos1, true));
  EXPECT_THAT(without.report, HasSubstr("not logged: imu"));

  // A frame that is forward-right-down already.
  topics[1].message = [](Wire wire, std::int64_t stamp_ns, int) {
    return imu_bytes(wire, stamp_ns, kRate, kForce, 0.0, "base_link_frd");
  };
  expect_inertial(flown(recording_of(topics, Wire::kRos1, true)).samples.imu);
}

TEST_F(LoggedFormats, RosFixWithTheClockOfAnotherRecorderIsDeliveredWhenMeasured) {
  std::vector<RosTopic> topics = ros_topics();
  for (RosTopic& topic : topics) {
    // The recorder's clock counts from the epoch, the stamps from the vehicle's start.
    topic.message = [message = topic.message](Wire wire, std::int64_t stamp_ns, int i) {
      return message(wire, stamp_ns - kRosStartNs + kNsPerS, i);
    };
  }
  const FlownSensors flown = this->flown(recording_of(topics, Wire::kRos1, true));
  expect_fix(flown.samples.gps, 547.0);
  EXPECT_EQ(flown.samples.gps.at(3).delivered_ns, flown.samples.gps.at(3).t_ns);
}

// --- LCM ---

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

TEST_F(LoggedFormats, LcmHasTheSensorsOfItsOwnTypes) {
  Bytes bytes;
  std::int64_t number = 0;
  for (int i = 0; i < kSteps; ++i) {
    const std::int64_t t_ns = kMeasuredEveryNs * i;
    const auto event = [&](const char* channel, const Bytes& data) {
      append(bytes, testing::lcm_event(number++, (kRosStartNs + t_ns) / 1000, channel, data));
    };
    event("A_TRUTH",
          testing::lcm_truth(t_ns, {0.0, 2.5 * i, 300.0}, Eigen::Quaterniond(0, 1, 0, 0)));
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
  append(bytes,
         testing::lcm_event(number++, (kRosStartNs + kMeasuredEveryNs) / 1000, "A_IMU", cut));
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

TEST_F(LoggedFormats, CsvHasTheSensorsThatAMappingNames) {
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
}  // namespace overfly::flight
