// Samples of sensors in messages whose bytes are written by the published definitions.
#include "flight/mavlink/sensor_messages.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "flight/mavlink/messages.hpp"
#include "flight/mavlink/payload.hpp"

namespace overfly::flight::mavlink {
namespace {

constexpr std::int64_t kLatestNs = 90'000'000'000;
constexpr std::uint8_t kPx4 = 12;
constexpr std::uint8_t kArduPilotFirmware = 3;

std::optional<MessageSamples> samples_in(MessageId id,
                                         const PayloadWriter& payload,
                                         std::uint8_t autopilot = kArduPilotFirmware) {
  const Frame frame{Version::kTwo, 0, 1, 1, static_cast<std::uint32_t>(id), false, payload.bytes()};
  return sensor_samples_of(frame, {kLatestNs, autopilot, 30.0});
}

void put_shorts(
    PayloadWriter& payload, std::size_t at, std::int16_t x, std::int16_t y, std::int16_t z) {
  payload.put(at, x).put(at + 2, y).put(at + 4, z);
}

/// An aircraft that stands level, nose to the north, in a field of 20, -2, 45 uT.
PayloadWriter raw_imu_at_rest() {
  PayloadWriter payload(29);
  payload.put(0, std::uint64_t{89'999'500});
  put_shorts(payload, 8, 0, 0, -1000);
  put_shorts(payload, 14, 5, -6, 7);
  put_shorts(payload, 20, 200, -20, 450);
  return payload;
}

TEST(SensorMessages, AtRestTheSpecificForcePointsUp) {
  const auto measured = samples_in(MessageId::kRawImu, raw_imu_at_rest());
  ASSERT_TRUE(measured && measured->samples.imu.size() == 1);
  const ImuSample& imu = measured->samples.imu[0];
  EXPECT_EQ(imu.t_ns, 89'999'500'000);
  // One g upwards is -z of forward-right-down.
  EXPECT_LT((imu.acceleration_m_s2 - Eigen::Vector3d(0, 0, -9.80665)).norm(), 1e-12);
  EXPECT_LT((imu.angular_rate_rad_s - Eigen::Vector3d(0.005, -0.006, 0.007)).norm(), 1e-12);
  ASSERT_EQ(measured->samples.magnetometer.size(), 1U);
  EXPECT_LT((measured->samples.magnetometer[0].field_ut - Eigen::Vector3d(20, -2, 45)).norm(),
            1e-12);
}

TEST(SensorMessages, RawUnitsAreKnownOfArduPilotOnly) {
  EXPECT_FALSE(samples_in(MessageId::kRawImu, raw_imu_at_rest(), kPx4));
  PayloadWriter payload(24);
  payload.put(0, std::uint32_t{89'990});
  put_shorts(payload, 4, 0, 0, -1000);
  const auto scaled = samples_in(MessageId::kScaledImu2, payload, kPx4);
  ASSERT_TRUE(scaled && scaled->samples.imu.size() == 1);
  EXPECT_EQ(scaled->samples.imu[0].t_ns, 89'990'000'000);
  EXPECT_TRUE(scaled->samples.magnetometer.empty()) << "zeros are no field";
}

TEST(SensorMessages, OfHighresImuOnlyUpdatedFieldsAreTaken) {
  PayloadWriter payload(63);
  payload.put(0, std::uint64_t{90'000'000}).put(16, -9.8F).put(32, 0.2F).put(44, 1013.25F);
  payload.put(56, 15.0F);
  EXPECT_FALSE(samples_in(MessageId::kHighresImu, payload));
  payload.put(60, std::uint16_t{0x0200});
  const auto pressure = samples_in(MessageId::kHighresImu, payload);
  ASSERT_TRUE(pressure && pressure->samples.barometer.size() == 1);
  EXPECT_TRUE(pressure->samples.imu.empty() && pressure->samples.magnetometer.empty());
  EXPECT_NEAR(pressure->samples.barometer[0].pressure_pa, 101325.0, 0.01);
  EXPECT_TRUE(std::isnan(pressure->samples.barometer[0].temperature_k));
  payload.put(60, std::uint16_t{0x1FFF});
  const auto all = samples_in(MessageId::kHighresImu, payload);
  EXPECT_NEAR(all->samples.barometer[0].temperature_k, 288.15, 1e-4);
  EXPECT_NEAR(all->samples.imu.at(0).acceleration_m_s2.z(), -9.8, 1e-6);
  EXPECT_NEAR(all->samples.magnetometer.at(0).field_ut.x(), 20.0, 1e-5);
  EXPECT_LT(all->preference, samples_in(MessageId::kRawImu, raw_imu_at_rest())->preference);
  payload.put(8, std::nanf(""));
  EXPECT_TRUE(samples_in(MessageId::kHighresImu, payload)->samples.imu.empty());
}

TEST(SensorMessages, PressureAndAirspeed) {
  const auto pressure = samples_in(
      MessageId::kScaledPressure,
      PayloadWriter(16).put(0, std::uint32_t{89'000}).put(4, 950.5F).put(12, std::int16_t{-1050}));
  ASSERT_TRUE(pressure);
  EXPECT_NEAR(pressure->samples.barometer.at(0).pressure_pa, 95050.0, 1e-9);
  EXPECT_NEAR(pressure->samples.barometer.at(0).temperature_k, 262.65, 1e-9);
  EXPECT_EQ(pressure->samples.barometer.at(0).t_ns, 89'000'000'000);
  const auto tube = samples_in(MessageId::kAirspeed, PayloadWriter(12).put(0, 20.0F).put(4, 2.5F));
  EXPECT_EQ(tube->samples.airspeed.at(0).indicated_airspeed_m_s, 20.0);
  EXPECT_EQ(tube->samples.airspeed.at(0).differential_pressure_pa, 250.0);
  const auto hud = samples_in(MessageId::kVfrHud, PayloadWriter(20).put(0, 20.0F));
  EXPECT_EQ(hud->samples.airspeed.at(0).t_ns, kLatestNs);
  EXPECT_NEAR(hud->samples.airspeed.at(0).differential_pressure_pa, 245.0, 1e-9);
  EXPECT_LT(tube->preference, hud->preference);
  EXPECT_FALSE(samples_in(MessageId::kVfrHud, PayloadWriter(20).put(0, -1.0F)));
}

PayloadWriter gps_raw(std::uint64_t time_us) {
  return PayloadWriter(52)
      .put(0, time_us)
      .put(8, std::int32_t{-353632620})
      .put(12, std::int32_t{1491652370})
      .put(16, std::int32_t{584'070})
      .put(24, std::uint16_t{2500})
      .put(26, std::uint16_t{9000})
      .put(28, std::uint8_t{3})
      .put(34, std::uint32_t{1200})
      .put(38, std::uint32_t{2500})
      .put(42, std::uint32_t{300});
}

TEST(SensorMessages, GpsHasItsTimeOfMeasurementAndOfDelivery) {
  const auto measured = samples_in(MessageId::kGpsRawInt, gps_raw(89'800'000));
  ASSERT_TRUE(measured);
  const GpsSample& gps = measured->samples.gps.at(0);
  EXPECT_EQ(gps.t_ns, 89'800'000'000);
  EXPECT_EQ(gps.delivered_ns, kLatestNs);
  EXPECT_NEAR(deg_from_rad(gps.place.lat_rad), -35.3632620, 1e-12);
  EXPECT_NEAR(deg_from_rad(gps.place.lon_rad), 149.1652370, 1e-12);
  EXPECT_NEAR(gps.place.alt_ellipsoid_m, 584.07 + 30.0, 1e-9);
  EXPECT_NEAR(gps.velocity_ned_m_s.x(), 0.0, 1e-12);
  EXPECT_NEAR(gps.velocity_ned_m_s.y(), 25.0, 1e-12);  // course 90 deg: east
  EXPECT_TRUE(std::isnan(gps.velocity_ned_m_s.z()));
  EXPECT_DOUBLE_EQ(gps.horizontal_accuracy_m, 1.2);
  EXPECT_DOUBLE_EQ(gps.vertical_accuracy_m, 2.5);
  EXPECT_DOUBLE_EQ(gps.speed_accuracy_m_s, 0.3);
  // UTC, as some receivers state it.
  EXPECT_EQ(samples_in(MessageId::kGpsRawInt, gps_raw(1'790'000'000'000'000))->samples.gps[0].t_ns,
            kLatestNs);
}

TEST(SensorMessages, GpsWithoutAFixSaysSo) {
  const auto measured =
      samples_in(MessageId::kGpsRawInt, gps_raw(89'800'000).put(28, std::uint8_t{1}));
  ASSERT_TRUE(measured);
  EXPECT_EQ(measured->samples.gps.at(0).fix, GpsFixType::kNone);
  EXPECT_EQ(measured->samples.gps.at(0).t_ns, kLatestNs);
  EXPECT_TRUE(std::isnan(measured->samples.gps.at(0).place.lat_rad));
  const auto unknown_speed =
      samples_in(MessageId::kGpsRawInt, gps_raw(89'800'000).put(24, std::uint16_t{0xFFFF}));
  EXPECT_TRUE(std::isnan(unknown_speed->samples.gps.at(0).velocity_ned_m_s.x()));
}

TEST(SensorMessages, SecondGpsHasItsFieldsElsewhere) {
  const auto measured = samples_in(MessageId::kGps2Raw,
                                   PayloadWriter(57)
                                       .put(0, std::uint64_t{89'900'000})
                                       .put(8, std::int32_t{100000000})
                                       .put(12, std::int32_t{200000000})
                                       .put(16, std::int32_t{1000})
                                       .put(28, std::uint16_t{1000})
                                       .put(30, std::uint16_t{18000})
                                       .put(32, std::uint8_t{4})
                                       .put(41, std::uint32_t{900}));
  ASSERT_TRUE(measured);
  const GpsSample& gps = measured->samples.gps.at(0);
  EXPECT_NEAR(gps.velocity_ned_m_s.x(), -10.0, 1e-12);
  EXPECT_DOUBLE_EQ(gps.horizontal_accuracy_m, 0.9);
  EXPECT_TRUE(std::isnan(gps.vertical_accuracy_m));
}

TEST(SensorMessages, RangesOfSensorsThatLookDown) {
  const auto distance = [](std::uint16_t cm, std::uint8_t orientation, std::uint8_t quality = 0) {
    return samples_in(MessageId::kDistanceSensor,
                      PayloadWriter(39)
                          .put(0, std::uint32_t{89'500})
                          .put(6, std::uint16_t{5000})
                          .put(8, cm)
                          .put(12, orientation)
                          .put(38, quality));
  };
  EXPECT_DOUBLE_EQ(distance(4321, 25)->samples.range.at(0).range_m, 43.21);
  EXPECT_EQ(distance(4321, 25)->samples.range.at(0).t_ns, 89'500'000'000);
  EXPECT_TRUE(std::isinf(distance(5000, 25)->samples.range.at(0).range_m));
  EXPECT_TRUE(std::isinf(distance(100, 25, 1)->samples.range.at(0).range_m));
  EXPECT_FALSE(distance(4321, 0));  // looks forward
  EXPECT_EQ(samples_in(MessageId::kRangefinder, PayloadWriter(8).put(0, 7.5F))
                ->samples.range.at(0)
                .range_m,
            7.5);
  EXPECT_FALSE(samples_in(MessageId::kRangefinder, PayloadWriter(8).put(0, std::nanf(""))));
}

TEST(SensorMessages, TimesFarFromTheVehiclesClockAreNotUsed) {
  for (const std::uint32_t odd_ms : {0U, 80'000U, 92'000U, 4'000'000'000U}) {
    const auto measured =
        samples_in(MessageId::kScaledPressure, PayloadWriter(16).put(0, odd_ms).put(4, 950.5F));
    EXPECT_EQ(measured->samples.barometer.at(0).t_ns, kLatestNs) << odd_ms;
  }
}

}  // namespace
}  // namespace overfly::flight::mavlink
