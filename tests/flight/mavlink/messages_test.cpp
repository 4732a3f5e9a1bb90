#include "flight/mavlink/messages.hpp"

#include <gtest/gtest.h>

#include "tests/flight/logs/log_bytes.hpp"

namespace overfly::flight::mavlink {
namespace {

using testing::Bytes;
using testing::put;

Frame frame_with(MessageId id, const Bytes& payload) {
  return {Version::kTwo, 0, 1, 1, static_cast<std::uint32_t>(id), false, payload};
}

TEST(MavlinkMessages, ScaleGlobalPositionInt) {
  const Bytes payload = testing::global_position_payload(454229, -353564430, 1491664820, 883810);
  const Frame frame = frame_with(MessageId::kGlobalPositionInt, payload);
  const GlobalPositionVelocity decoded = decode_global_position(frame);
  EXPECT_DOUBLE_EQ(decoded.position.lat_deg, -35.3564430);
  EXPECT_DOUBLE_EQ(decoded.position.lon_deg, 149.1664820);
  EXPECT_DOUBLE_EQ(decoded.position.alt_msl_m, 883.810);
  EXPECT_DOUBLE_EQ(decoded.velocity_ned_m_s.x(), 25.0);
  EXPECT_EQ(boot_time_ns(frame), 454'229'000'000);
}

TEST(MavlinkMessages, ReadCutPayloadsAsZeros) {
  Bytes payload = testing::attitude_payload(7, 0.5F, 0.0F, 0.0F);
  payload.resize(8);
  const Attitude decoded = decode_attitude(frame_with(MessageId::kAttitude, payload));
  EXPECT_FLOAT_EQ(static_cast<float>(decoded.angles.roll_rad), 0.5F);
  EXPECT_EQ(decoded.angles.yaw_rad, 0.0);
  payload.resize(6);  // within the number: the missing bytes are the high ones
  EXPECT_NEAR(decode_attitude(frame_with(MessageId::kAttitude, payload)).angles.roll_rad, 0, 1e-30);
  EXPECT_EQ(decode_attitude(frame_with(MessageId::kAttitude, {})).angles.roll_rad, 0.0);
}

TEST(MavlinkMessages, PreferTheIntegersOfSimState) {
  Bytes payload;
  for (int i = 0; i < 21; ++i) put(payload, i == 0 ? 1.0F : 0.0F);
  const auto set_float = [&](std::size_t offset, float value) {
    std::memcpy(payload.data() + offset, &value, sizeof value);
  };
  set_float(52, -353564352.0F);
  set_float(56, 1491664896.0F);
  set_float(60, 883.72F);
  const auto decoded = [&] { return decode_sim_state(frame_with(MessageId::kSimState, payload)); };
  EXPECT_NEAR(decoded().position.lat_deg, -35.3564352, 1e-9);
  put(payload, std::int32_t{-353564360});
  put(payload, std::int32_t{1491664888});
  EXPECT_DOUBLE_EQ(decoded().position.lat_deg, -35.3564360);
  EXPECT_DOUBLE_EQ(decoded().position.lon_deg, 149.1664888);
  EXPECT_FLOAT_EQ(static_cast<float>(decoded().position.alt_msl_m), 883.72F);
  payload.resize(84);
  set_float(52, 47.5F);  // a sender that keeps to the definition: degrees
  set_float(56, 8.25F);
  EXPECT_DOUBLE_EQ(decoded().position.lat_deg, 47.5);
  EXPECT_DOUBLE_EQ(decoded().position.lon_deg, 8.25);
}

TEST(MavlinkMessages, ConvertInertialUnits) {
  Bytes scaled;
  put(scaled, std::uint32_t{10});
  for (const std::int16_t value : {0, 0, -1000, 500, 0, 0, 0, 0, 0}) put(scaled, value);
  const Imu imu = decode_imu(frame_with(MessageId::kScaledImu2, scaled));
  EXPECT_DOUBLE_EQ(imu.acceleration_m_s2.z(), -9.80665);
  EXPECT_DOUBLE_EQ(imu.rate_rad_s.x(), 0.5);
  Bytes raw;
  put(raw, std::uint64_t{10});
  for (const std::int16_t value : {1000, 0, 0, 0, 0, 250}) put(raw, value);
  EXPECT_DOUBLE_EQ(decode_imu(frame_with(MessageId::kRawImu, raw)).acceleration_m_s2.x(), 9.80665);
  EXPECT_DOUBLE_EQ(decode_imu(frame_with(MessageId::kRawImu, raw)).rate_rad_s.z(), 0.25);
  Bytes highres;
  put(highres, std::uint64_t{10});
  for (const float value : {1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F}) put(highres, value);
  const Imu precise = decode_imu(frame_with(MessageId::kHighresImu, highres));
  EXPECT_EQ(precise.acceleration_m_s2, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(precise.rate_rad_s, Eigen::Vector3d(4, 5, 6));
}

TEST(MavlinkMessages, TakeNoTimeSince1970ForATimeSinceBoot) {
  Bytes raw;
  put(raw, std::uint64_t{1'795'228'543'000'000});
  EXPECT_EQ(boot_time_ns(frame_with(MessageId::kRawImu, raw)), std::nullopt);
  EXPECT_EQ(boot_time_ns(frame_with(MessageId::kSimState, raw)), std::nullopt);
}

TEST(MavlinkMessages, DecodeTheRest) {
  Bytes gps;
  put(gps, std::uint64_t{1});
  for (const std::int32_t value : {470000000, 80000000, 500000}) put(gps, value);
  for (int i = 0; i < 4; ++i) put(gps, std::uint16_t{0});
  gps.push_back(6);
  gps.push_back(11);
  EXPECT_EQ(decode_gps_raw(frame_with(MessageId::kGpsRawInt, gps)).alt_ellipsoid_m, std::nullopt);
  put(gps, std::int32_t{547500});
  const GpsRaw fix = decode_gps_raw(frame_with(MessageId::kGpsRawInt, gps));
  EXPECT_EQ(fix.fix_type, 6);
  EXPECT_EQ(fix.satellites, 11);
  EXPECT_DOUBLE_EQ(*fix.alt_ellipsoid_m, 547.5);

  Bytes text = {4};
  testing::put_text(text, std::string("Hello \x01 there"), 50);
  const StatusText status = decode_status_text(frame_with(MessageId::kStatusText, text));
  EXPECT_EQ(status.severity, 4);
  EXPECT_EQ(status.text, "Hello ? there");

  Bytes heartbeat;
  put(heartbeat, std::uint32_t{10});
  for (const std::uint8_t value : {1, 3, 0x81, 4, 3}) heartbeat.push_back(value);
  EXPECT_EQ(decode_heartbeat(frame_with(MessageId::kHeartbeat, heartbeat)).custom_mode, 10U);
  EXPECT_TRUE(decode_heartbeat(frame_with(MessageId::kHeartbeat, heartbeat)).armed());

  Bytes floats;
  for (const float value : {1.0F, 2.0F, 3.0F, 4.0F}) put(floats, value);
  const VfrHud hud = decode_vfr_hud(frame_with(MessageId::kVfrHud, floats));
  EXPECT_EQ(hud.airspeed_m_s, 1.0);
  EXPECT_EQ(hud.groundspeed_m_s, 2.0);
  EXPECT_EQ(hud.alt_msl_m, 3.0);
  EXPECT_EQ(hud.climb_m_s, 4.0);
  EXPECT_EQ(decode_airspeed_m_s(frame_with(MessageId::kAirspeed, floats)), 1.0);

  Bytes time;
  put(time, std::uint64_t{1'795'228'542'671'417});
  put(time, std::uint32_t{453735});
  EXPECT_EQ(decode_system_time(frame_with(MessageId::kSystemTime, time)).unix_us,
            1'795'228'542'671'417);
  EXPECT_EQ(decode_system_time(frame_with(MessageId::kSystemTime, time)).boot_ns, 453'735'000'000);
}

}  // namespace
}  // namespace overfly::flight::mavlink
