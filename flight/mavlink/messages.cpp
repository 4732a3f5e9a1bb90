#include "flight/mavlink/messages.hpp"

#include <cmath>

#include "flight/mavlink/payload.hpp"

namespace overfly::flight::mavlink {
namespace {

constexpr std::int64_t kNsPerMs = 1'000'000;
constexpr std::int64_t kNsPerUs = 1'000;
/// One thousandth of standard gravity, the unit of SCALED_IMU [m/s^2].
constexpr double kMilliGravity = 9.80665e-3;
constexpr double kDegPerUnit = 1e-7;

Eigen::Vector3d floats_at(const PayloadReader& payload, std::size_t offset) {
  return {payload.at<float>(offset), payload.at<float>(offset + 4), payload.at<float>(offset + 8)};
}

Eigen::Vector3d shorts_at(const PayloadReader& payload, std::size_t offset, double unit) {
  return unit * Eigen::Vector3d(payload.at<std::int16_t>(offset),
                                payload.at<std::int16_t>(offset + 2),
                                payload.at<std::int16_t>(offset + 4));
}

/// Four floats in the order w, x, y, z.
Eigen::Quaterniond quaternion_at(const PayloadReader& payload, std::size_t offset) {
  return {payload.at<float>(offset),
          payload.at<float>(offset + 4),
          payload.at<float>(offset + 8),
          payload.at<float>(offset + 12)};
}

RollPitchYaw angles_at(const PayloadReader& payload, std::size_t offset) {
  const Eigen::Vector3d angles = floats_at(payload, offset);
  return {angles.x(), angles.y(), angles.z()};
}

/// Latitude, longitude [1e-7 deg] and height [mm].
GlobalPosition integer_position_at(const PayloadReader& payload, std::size_t offset) {
  return {payload.at<std::int32_t>(offset) * kDegPerUnit,
          payload.at<std::int32_t>(offset + 4) * kDegPerUnit,
          payload.at<std::int32_t>(offset + 8) * 1e-3};
}

/// Microseconds since the start. Times since 1970 are not times since the start.
std::optional<std::int64_t> since_boot(std::uint64_t time_us) {
  constexpr std::uint64_t kYearUs = 365ULL * 86400 * 1'000'000;
  if (time_us > kYearUs) return std::nullopt;
  return static_cast<std::int64_t>(time_us) * kNsPerUs;
}

}  // namespace

std::optional<std::int64_t> boot_time_ns(const Frame& frame) {
  const PayloadReader payload(frame.payload);
  switch (static_cast<MessageId>(frame.message_id)) {
    case MessageId::kSystemTime:
      return payload.at<std::uint32_t>(8) * kNsPerMs;
    case MessageId::kScaledImu:
    case MessageId::kAttitude:
    case MessageId::kAttitudeQuaternion:
    case MessageId::kLocalPositionNed:
    case MessageId::kGlobalPositionInt:
    case MessageId::kScaledImu2:
    case MessageId::kScaledImu3:
      return payload.at<std::uint32_t>(0) * kNsPerMs;
    case MessageId::kRawImu:
    case MessageId::kHighresImu:
    case MessageId::kHilStateQuaternion:
      return since_boot(payload.at<std::uint64_t>(0));
    default:
      return std::nullopt;
  }
}

Heartbeat decode_heartbeat(const Frame& frame) {
  const PayloadReader payload(frame.payload);
  return {payload.at<std::uint32_t>(0),
          payload.at<std::uint8_t>(4),
          payload.at<std::uint8_t>(5),
          payload.at<std::uint8_t>(6)};
}

SystemTime decode_system_time(const Frame& frame) {
  const PayloadReader payload(frame.payload);
  return {payload.at<std::int64_t>(0), payload.at<std::uint32_t>(8) * kNsPerMs};
}

GpsRaw decode_gps_raw(const Frame& frame) {
  const PayloadReader payload(frame.payload);
  GpsRaw gps;
  gps.fix_type = payload.at<std::uint8_t>(28);
  gps.position = integer_position_at(payload, 8);
  const auto ellipsoid_mm = payload.at<std::int32_t>(30);
  if (ellipsoid_mm != 0) gps.alt_ellipsoid_m = ellipsoid_mm * 1e-3;
  gps.satellites = payload.at<std::uint8_t>(29);
  return gps;
}

Attitude decode_attitude(const Frame& frame) {
  const PayloadReader payload(frame.payload);
  return {angles_at(payload, 4), floats_at(payload, 16)};
}

AttitudeQuaternion decode_attitude_quaternion(const Frame& frame) {
  const PayloadReader payload(frame.payload);
  return {quaternion_at(payload, 4), floats_at(payload, 20)};
}

LocalPosition decode_local_position(const Frame& frame) {
  const PayloadReader payload(frame.payload);
  return {floats_at(payload, 4), floats_at(payload, 16)};
}

GlobalPositionVelocity decode_global_position(const Frame& frame) {
  const PayloadReader payload(frame.payload);
  return {integer_position_at(payload, 4), shorts_at(payload, 20, 0.01)};
}

GlobalPosition decode_gps_global_origin(const Frame& frame) {
  return integer_position_at(PayloadReader(frame.payload), 0);
}

SimulatedState decode_sim_state(const Frame& frame) {
  const PayloadReader payload(frame.payload);
  const auto lat_int = payload.at<std::int32_t>(84);
  const auto lon_int = payload.at<std::int32_t>(88);
  SimulatedState state;
  state.position = {lat_int * kDegPerUnit, lon_int * kDegPerUnit, payload.at<float>(60)};
  if (lat_int == 0 && lon_int == 0) {
    const double lat = payload.at<float>(52);
    const double lon = payload.at<float>(56);
    const bool degrees = std::abs(lat) <= 90.0 && std::abs(lon) <= 360.0;
    const double unit = degrees ? 1.0 : kDegPerUnit;
    state.position.lat_deg = lat * unit;
    state.position.lon_deg = lon * unit;
  }
  state.R_ned_body = quaternion_at(payload, 0);
  state.velocity_ned_m_s = floats_at(payload, 72);
  state.rate_rad_s = floats_at(payload, 40);
  return state;
}

SimulatedState decode_hil_state_quaternion(const Frame& frame) {
  const PayloadReader payload(frame.payload);
  return {integer_position_at(payload, 36),
          quaternion_at(payload, 8),
          shorts_at(payload, 48, 0.01),
          floats_at(payload, 24)};
}

Attitude decode_simstate(const Frame& frame) {
  const PayloadReader payload(frame.payload);
  return {angles_at(payload, 0), floats_at(payload, 24)};
}

VfrHud decode_vfr_hud(const Frame& frame) {
  const PayloadReader payload(frame.payload);
  return {payload.at<float>(0), payload.at<float>(4), payload.at<float>(8), payload.at<float>(12)};
}

Imu decode_imu(const Frame& frame) {
  const PayloadReader payload(frame.payload);
  switch (static_cast<MessageId>(frame.message_id)) {
    case MessageId::kHighresImu:
      return {floats_at(payload, 20), floats_at(payload, 8)};
    case MessageId::kRawImu:
      return {shorts_at(payload, 14, 1e-3), shorts_at(payload, 8, kMilliGravity)};
    default:
      return {shorts_at(payload, 10, 1e-3), shorts_at(payload, 4, kMilliGravity)};
  }
}

Ahrs2 decode_ahrs2(const Frame& frame) {
  const PayloadReader payload(frame.payload);
  return {angles_at(payload, 0),
          {payload.at<std::int32_t>(16) * kDegPerUnit,
           payload.at<std::int32_t>(20) * kDegPerUnit,
           payload.at<float>(12)}};
}

std::uint16_t decode_mission_sequence(const Frame& frame) {
  return PayloadReader(frame.payload).at<std::uint16_t>(0);
}

StatusText decode_status_text(const Frame& frame) {
  const PayloadReader payload(frame.payload);
  return {payload.at<std::uint8_t>(0), payload.text(1, 50)};
}

double decode_airspeed_m_s(const Frame& frame) { return PayloadReader(frame.payload).at<float>(0); }

}  // namespace overfly::flight::mavlink
