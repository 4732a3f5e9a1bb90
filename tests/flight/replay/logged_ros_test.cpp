// The sensors in ROS bags and MCAP files, made by hand: the known measurement with signs and units
// as the format defines them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/time.hpp"
#include "tests/flight/logs/log_bytes.hpp"
#include "tests/flight/logs/ros_bytes.hpp"
#include "tests/flight/replay/known_measurement.hpp"

namespace overfly::flight::testing {
namespace {

using ::testing::HasSubstr;

using LoggedRos = LoggedFormats;

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
  Bytes bytes = bag ? bag_start(0) : mcap_start("");
  const std::string between = wire == Wire::kRos1 ? "/" : "/msg/";
  std::uint16_t id = 1;
  for (const RosTopic& topic : topics) {
    const std::string type = topic.package + between + topic.type;
    if (bag) {
      append(bytes, bag_connection(id, topic.name, type));
    } else {
      append(bytes, mcap_schema(id, type));
      const char* const encoding = wire == Wire::kRos1 ? "ros1" : "cdr";
      append(bytes, mcap_channel(id, id, topic.name, encoding));
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
             bag ? bag_message(id, recorded_ns, data)
                 : mcap_message(id, static_cast<std::uint64_t>(recorded_ns), data));
      ++id;
    }
  }
  if (!bag) append(bytes, mcap_end());
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

TEST_F(LoggedRos, RosBagsHaveTheirSensorsInBodyAxes) {
  expect_all_of_ros(flown(recording_of(ros_topics(), Wire::kRos1, true)));
}

TEST_F(LoggedRos, McapHasTheSensorsOfBothVersionsOfRos) {
  for (const Wire wire : {Wire::kRos1, Wire::kCdrLittle, Wire::kCdrBig}) {
    expect_all_of_ros(flown(recording_of(ros_topics(), wire, false)));
  }
}

TEST_F(LoggedRos, RosImuIsLeftOutWithoutAccelerationsAndOfTruth) {
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

  // "frd" as the end of another word.
  topics[1].message = [](Wire wire, std::int64_t stamp_ns, int) {
    return imu_bytes(wire, stamp_ns, flu(kRate), flu(kForce), 0.0, "imu_of_wharfrd");
  };
  expect_inertial(flown(recording_of(topics, Wire::kRos1, true)).samples.imu);
}

TEST_F(LoggedRos, RosFixWithTheClockOfAnotherRecorderIsDeliveredWhenMeasured) {
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

}  // namespace
}  // namespace overfly::flight::testing
