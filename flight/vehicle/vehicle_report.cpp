#include "flight/vehicle/vehicle_report.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/motion/pose.hpp"
#include "flight/mavlink/autopilots.hpp"
#include "flight/vehicle/report_fields.hpp"
#include "flight/vehicle/sensor_report.hpp"

namespace overfly::vehicle {
namespace {

using flight::mavlink::MessageId;
using flight::mavlink::PayloadWriter;

double heading_deg(const VehicleReport& report) {
  const double deg = deg_from_rad(report.state.attitude.yaw_rad);
  return deg < 0.0 ? deg + 360.0 : deg;
}

PayloadWriter heartbeat(const VehicleReport& report) {
  constexpr std::uint8_t kFixedWing = 1;
  constexpr std::uint8_t kCustomModeAndSimulation = 0x01 | 0x20;
  constexpr std::uint8_t kActive = 4;
  constexpr std::uint8_t kStandby = 3;
  return PayloadWriter(9)
      .put(0, static_cast<std::uint32_t>(report.mode))
      .put(4, kFixedWing)
      .put(5, flight::mavlink::kArduPilot)
      .put(6, static_cast<std::uint8_t>(kCustomModeAndSimulation | (report.armed ? 0x80 : 0)))
      .put(7, report.armed ? kActive : kStandby)
      .put(8, std::uint8_t{3});
}

PayloadWriter system_time(const VehicleReport& report) {
  return PayloadWriter(12)
      .put(0, static_cast<std::uint64_t>(report.unix_ns / 1000))
      .put(8, boot_ms(report));
}

PayloadWriter system_status() {
  constexpr std::uint32_t kSensors = 0x3F | 0x200000;  // IMU, magnetometer, pressures, GPS, AHRS
  // ArduPilot calls an absent fence healthy; ground stations take anything else for a breach.
  constexpr std::uint32_t kFence = 0x100000;
  return PayloadWriter(43)
      .put(0, kSensors)
      .put(4, kSensors)
      .put(8, kSensors | kFence)
      .put(14, std::uint16_t{11100})  // mV; the model's battery does not drain
      .put(16, std::int16_t{-1})
      .put(30, std::int8_t{100});
}

PayloadWriter attitude(const VehicleReport& report) {
  const auto& angles = report.state.attitude;
  PayloadWriter payload(28);
  payload.put(0, boot_ms(report))
      .put(4, static_cast<float>(angles.roll_rad))
      .put(8, static_cast<float>(angles.pitch_rad))
      .put(12, static_cast<float>(angles.yaw_rad));
  put_rates(payload, 16, report);
  return payload;
}

void put_quaternion(PayloadWriter& payload, std::size_t at, const VehicleReport& report) {
  const Eigen::Quaternionf q = R_ned_body(report).cast<float>();
  payload.put(at, q.w()).put(at + 4, q.x()).put(at + 8, q.y()).put(at + 12, q.z());
}

PayloadWriter attitude_quaternion(const VehicleReport& report) {
  PayloadWriter payload(48);
  payload.put(0, boot_ms(report));
  put_quaternion(payload, 4, report);
  put_rates(payload, 20, report);
  return payload;
}

PayloadWriter local_position(const VehicleReport& report) {
  PayloadWriter payload(28);
  payload.put(0, boot_ms(report));
  put_vector(payload, 4, ned(report.state.position_world_m));
  put_vector(payload, 16, ned(report.state.v_world_m_s));
  return payload;
}

PayloadWriter global_position(const VehicleReport& report) {
  const Geodetic at = report.frame.geodetic_from_world(report.state.position_world_m);
  const Eigen::Vector3f v = 100.0F * ned(report.state.v_world_m_s);
  return PayloadWriter(28)
      .put(0, boot_ms(report))
      .put(4, field<std::int32_t>(1e7 * deg_from_rad(at.lat_rad)))
      .put(8, field<std::int32_t>(1e7 * deg_from_rad(at.lon_rad)))
      .put(12, field<std::int32_t>(1e3 * at.alt_ellipsoid_m))
      .put(16, field<std::int32_t>(1e3 * report.height_above_home_m))
      .put(20, field<std::int16_t>(v.x()))
      .put(22, field<std::int16_t>(v.y()))
      .put(24, field<std::int16_t>(v.z()))
      .put(26, static_cast<std::uint16_t>(std::min(35999.0, 100.0 * heading_deg(report))));
}

PayloadWriter gps(const VehicleReport& report) {
  const Geodetic at = report.frame.geodetic_from_world(report.state.position_world_m);
  const Eigen::Vector2d v = report.state.v_world_m_s.head<2>();
  const double course = std::atan2(v.x(), v.y());
  return PayloadWriter(52)
      .put(0, static_cast<std::uint64_t>(report.boot_ns / 1000))
      .put(8, field<std::int32_t>(1e7 * deg_from_rad(at.lat_rad)))
      .put(12, field<std::int32_t>(1e7 * deg_from_rad(at.lon_rad)))
      .put(16, field<std::int32_t>(1e3 * at.alt_ellipsoid_m))
      .put(20, std::uint16_t{80})
      .put(22, std::uint16_t{120})
      .put(24, field<std::uint16_t>(100.0 * v.norm()))
      .put(26,
           field<std::uint16_t>(100.0 * deg_from_rad(course < 0.0 ? course + 2.0 * kPi : course)))
      .put(28, std::uint8_t{3})
      .put(29, std::uint8_t{12});
}

PayloadWriter hud(const VehicleReport& report) {
  const Geodetic at = report.frame.geodetic_from_world(report.state.position_world_m);
  // Of an aeroplane, VFR_HUD has the indicated airspeed.
  const double density = dynamics::standard_density_kg_m3(at.alt_ellipsoid_m);
  const double indicated_m_s = report.state.airspeed_m_s * std::sqrt(density / 1.225);
  return PayloadWriter(20)
      .put(0, static_cast<float>(indicated_m_s))
      .put(4, static_cast<float>(report.state.v_world_m_s.head<2>().norm()))
      .put(8, static_cast<float>(at.alt_ellipsoid_m))
      .put(12, static_cast<float>(report.state.v_world_m_s.z()))
      .put(16, field<std::int16_t>(heading_deg(report)))
      .put(18, field<std::uint16_t>(100.0 * report.throttle));
}

/// "Total number of mission items" of MISSION_CURRENT, which is the number of the last item: item 0
/// is the home position, and UINT16_MAX stands for no mission.
std::uint16_t mission_total(const VehicleReport& report) {
  constexpr std::uint16_t kNoMission = 0xFFFF;
  return report.mission_items == 0 ? kNoMission
                                   : static_cast<std::uint16_t>(report.mission_items - 1);
}

/// The true state: SIM_STATE as ArduPilot sends it, with latitude and longitude as integers too.
PayloadWriter simulated_state(const VehicleReport& report) {
  const Geodetic at = report.frame.geodetic_from_world(report.state.position_world_m);
  PayloadWriter payload(92);
  put_quaternion(payload, 0, report);
  const auto& angles = report.state.attitude;
  payload.put(16, static_cast<float>(angles.roll_rad))
      .put(20, static_cast<float>(angles.pitch_rad))
      .put(24, static_cast<float>(angles.yaw_rad));
  put_vector(payload, 28, report.state.specific_force_body_m_s2.cast<float>());
  put_rates(payload, 40, report);
  payload.put(52, static_cast<float>(deg_from_rad(at.lat_rad)))
      .put(56, static_cast<float>(deg_from_rad(at.lon_rad)))
      .put(60, static_cast<float>(at.alt_ellipsoid_m));
  put_vector(payload, 72, ned(report.state.v_world_m_s));
  return payload.put(84, field<std::int32_t>(1e7 * deg_from_rad(at.lat_rad)))
      .put(88, field<std::int32_t>(1e7 * deg_from_rad(at.lon_rad)));
}

PayloadWriter home_position(const VehicleReport& report) {
  const Geodetic& home = report.frame.origin();
  return PayloadWriter(60)
      .put(0, field<std::int32_t>(1e7 * deg_from_rad(home.lat_rad)))
      .put(4, field<std::int32_t>(1e7 * deg_from_rad(home.lon_rad)))
      .put(8, field<std::int32_t>(1e3 * home.alt_ellipsoid_m))
      .put(24, 1.0F);
}

PayloadWriter global_origin(const VehicleReport& report) {
  const Geodetic& home = report.frame.origin();
  return PayloadWriter(20)
      .put(0, field<std::int32_t>(1e7 * deg_from_rad(home.lat_rad)))
      .put(4, field<std::int32_t>(1e7 * deg_from_rad(home.lon_rad)))
      .put(8, field<std::int32_t>(1e3 * home.alt_ellipsoid_m));
}

PayloadWriter autopilot_version() {
  // MISSION_FLOAT, PARAM_FLOAT, MISSION_INT, COMMAND_INT, MAVLINK2 (MAV_PROTOCOL_CAPABILITY).
  constexpr std::uint64_t kCapabilities = 1U | 2U | 4U | 8U | 8192U;
  return PayloadWriter(78).put(0, kCapabilities);
}

}  // namespace

std::optional<PayloadWriter> payload_of(MessageId id, const VehicleReport& report) {
  switch (id) {
    case MessageId::kHeartbeat:
      return heartbeat(report);
    case MessageId::kSystemTime:
      return system_time(report);
    case MessageId::kSysStatus:
      return system_status();
    case MessageId::kAttitude:
      return attitude(report);
    case MessageId::kAttitudeQuaternion:
      return attitude_quaternion(report);
    case MessageId::kLocalPositionNed:
      return local_position(report);
    case MessageId::kGlobalPositionInt:
      return global_position(report);
    case MessageId::kGpsRawInt:
      return gps(report);
    case MessageId::kVfrHud:
      return hud(report);
    case MessageId::kSimState:
      return simulated_state(report);
    case MessageId::kHomePosition:
      return home_position(report);
    case MessageId::kGpsGlobalOrigin:
      return global_origin(report);
    case MessageId::kAutopilotVersion:
      return autopilot_version();
    case MessageId::kMissionCurrent:
      return PayloadWriter(18).put(0, report.mission_item).put(2, mission_total(report));
    case MessageId::kExtendedSysState:
      // MAV_LANDED_STATE: 1 on the ground, 2 in the air.
      return PayloadWriter(2).put(1, static_cast<std::uint8_t>(report.in_air ? 2 : 1));
    default:
      return sensor_payload_of(id, report);
  }
}

}  // namespace overfly::vehicle
