// Samples of a vehicle's sensors between its messages and a run.
#include "flight/live/live_sensors.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "flight/mavlink/messages.hpp"
#include "flight/mavlink/payload.hpp"

namespace overfly::flight::live {
namespace {

using mavlink::MessageId;
using mavlink::PayloadWriter;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::int64_t kMillisNs = 1'000'000;

void give(LiveSensors& sensors,
          MessageId id,
          const PayloadWriter& payload,
          std::int64_t latest_ns) {
  sensors.take(
      {mavlink::Version::kTwo, 0, 1, 1, static_cast<std::uint32_t>(id), false, payload.bytes()},
      latest_ns);
}

/// Specific force along x: the number of the message.
void scaled_imu(LiveSensors& sensors, MessageId id, std::uint32_t boot_ms, std::int16_t x) {
  give(sensors, id, PayloadWriter(24).put(0, boot_ms).put(4, x), boot_ms * kMillisNs);
}

std::vector<std::int64_t> times_ms(const std::vector<ImuSample>& samples) {
  std::vector<std::int64_t> times;
  for (const ImuSample& sample : samples) times.push_back(sample.t_ns / kMillisNs);
  return times;
}

TEST(LiveSensors, TimesCountFromTheFlightsStart) {
  LiveSensors sensors(0.0);
  for (const std::uint32_t ms : {990U, 1010U, 1020U, 1040U}) {
    scaled_imu(sensors, MessageId::kScaledImu, ms, 0);
  }
  EXPECT_THAT(times_ms(sensors.take_until(1030 * kMillisNs, 1000 * kMillisNs).imu),
              ElementsAre(10, 20));
  EXPECT_THAT(times_ms(sensors.take_until(1050 * kMillisNs, 1000 * kMillisNs).imu),
              ElementsAre(40));
  EXPECT_TRUE(sensors.take_until(2000 * kMillisNs, 1000 * kMillisNs).empty());
}

TEST(LiveSensors, LateMessagesAreOrderedAndDoubleOnesLeftOut) {
  LiveSensors sensors(0.0);
  for (const std::uint32_t ms : {1010U, 1030U, 1020U, 1030U, 1050U}) {
    scaled_imu(sensors, MessageId::kScaledImu, ms, 0);
  }
  EXPECT_THAT(times_ms(sensors.take_until(1040 * kMillisNs, 0).imu), ElementsAre(1010, 1020, 1030));
  // One that was due already comes with the next frame, unless later ones are gone.
  scaled_imu(sensors, MessageId::kScaledImu, 1035, 0);
  scaled_imu(sensors, MessageId::kScaledImu, 1025, 0);
  EXPECT_THAT(times_ms(sensors.take_until(1060 * kMillisNs, 0).imu), ElementsAre(1035, 1050));
  EXPECT_THAT(sensors.report(), HasSubstr("1 samples came too late"));
}

void high_resolution_imu(LiveSensors& sensors, std::uint64_t boot_ms) {
  give(sensors,
       MessageId::kHighresImu,
       PayloadWriter(63).put(0, 1000 * boot_ms).put(60, std::uint16_t{0x3F}),
       static_cast<std::int64_t>(boot_ms) * kMillisNs);
}

TEST(LiveSensors, EachSensorHasOneMessage) {
  LiveSensors sensors(0.0);
  scaled_imu(sensors, MessageId::kScaledImu2, 1000, 200);
  scaled_imu(sensors, MessageId::kScaledImu, 1005, 100);
  scaled_imu(sensors, MessageId::kScaledImu2, 1010, 200);
  const SensorSamples first = sensors.take_until(1020 * kMillisNs, 0);
  ASSERT_EQ(first.imu.size(), 1U);
  EXPECT_NEAR(first.imu[0].acceleration_m_s2.x(), 0.980665, 1e-12);
  // A better one that comes during the flight does not change the source.
  high_resolution_imu(sensors, 2010);
  EXPECT_TRUE(sensors.take_until(2020 * kMillisNs, 0).imu.empty());
  scaled_imu(sensors, MessageId::kScaledImu, 2105, 100);
  EXPECT_EQ(sensors.take_until(2200 * kMillisNs, 0).imu.size(), 1U);
  EXPECT_EQ(sensors.report(),
            "sensors of the vehicle: imu from SCALED_IMU (0.9 Hz); not sent: barometer, gps, "
            "airspeed, magnetometer, range");
}

TEST(LiveSensors, ABetterMessageReplacesTheFirstOneAtTheStart) {
  LiveSensors sensors(0.0);
  scaled_imu(sensors, MessageId::kScaledImu, 1000, 100);
  EXPECT_THAT(times_ms(sensors.take_until(1010 * kMillisNs, 0).imu), ElementsAre(1000));
  scaled_imu(sensors, MessageId::kScaledImu, 1020, 100);
  high_resolution_imu(sensors, 995);  // before what was taken
  high_resolution_imu(sensors, 1025);
  scaled_imu(sensors, MessageId::kScaledImu, 1030, 100);
  high_resolution_imu(sensors, 1125);
  EXPECT_THAT(times_ms(sensors.take_until(1200 * kMillisNs, 0).imu), ElementsAre(1025, 1125));
  EXPECT_THAT(sensors.report(), HasSubstr("imu from HIGHRES_IMU (10.0 Hz)"));
}

TEST(LiveSensors, AFixThatIsSentAgainIsNotMeasuredAgain) {
  LiveSensors sensors(0.0);
  const auto fix = [&](std::uint64_t time_us, std::int64_t latest_ms, std::uint8_t type = 3) {
    give(sensors,
         MessageId::kGpsRawInt,
         PayloadWriter(52).put(0, time_us).put(8, std::int32_t{10}).put(28, type),
         latest_ms * kMillisNs);
  };
  fix(1'000'000, 1100);
  fix(1'000'000, 1200);
  EXPECT_EQ(sensors.take_until(1150 * kMillisNs, 0).gps.size(), 1U);
  fix(1'000'000, 1300);
  fix(1'200'000, 1400);
  fix(1'200'000, 1500, 0);
  const SensorSamples later = sensors.take_until(2000 * kMillisNs, 0);
  ASSERT_EQ(later.gps.size(), 2U);
  EXPECT_EQ(later.gps[0].t_ns, 1200 * kMillisNs);
  EXPECT_EQ(later.gps[0].delivered_ns, 1400 * kMillisNs);
  EXPECT_EQ(later.gps[1].fix, GpsFixType::kNone);
}

TEST(LiveSensors, SaysNothingWithoutSamples) { EXPECT_EQ(LiveSensors(0.0).report(), ""); }

}  // namespace
}  // namespace overfly::flight::live
