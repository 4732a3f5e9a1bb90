// The MAVLink messages that describe a flight, decoded to SI units.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>

#include "core/motion/pose.hpp"
#include "flight/mavlink/autopilots.hpp"
#include "flight/mavlink/frame.hpp"

namespace overfly::flight::mavlink {

/// Ids of the messages that are decoded or sent.
enum class MessageId : std::uint32_t {
  kHeartbeat = 0,
  kSysStatus = 1,
  kSystemTime = 2,
  kSetMode = 11,
  kParamRequestRead = 20,
  kParamRequestList = 21,
  kParamValue = 22,
  kParamSet = 23,
  kGpsRawInt = 24,
  kScaledImu = 26,
  kRawImu = 27,
  kScaledPressure = 29,
  kAttitude = 30,
  kAttitudeQuaternion = 31,
  kLocalPositionNed = 32,
  kGlobalPositionInt = 33,
  kMissionItem = 39,
  kMissionRequest = 40,
  kMissionSetCurrent = 41,
  kMissionCurrent = 42,
  kMissionRequestList = 43,
  kMissionCount = 44,
  kMissionClearAll = 45,
  kMissionItemReached = 46,
  kMissionAck = 47,
  kSetGpsGlobalOrigin = 48,
  kGpsGlobalOrigin = 49,
  kMissionRequestInt = 51,
  kRequestDataStream = 66,
  kMissionItemInt = 73,
  kVfrHud = 74,
  kCommandInt = 75,
  kCommandLong = 76,
  kCommandAck = 77,
  kVisionPositionEstimate = 102,
  kHighresImu = 105,
  kSimState = 108,
  kTimesync = 111,
  kCameraTrigger = 112,
  kHilStateQuaternion = 115,
  kScaledImu2 = 116,
  kGps2Raw = 124,
  kScaledImu3 = 129,
  kDistanceSensor = 132,
  kAutopilotVersion = 148,
  kSimstate = 164,
  kRangefinder = 173,
  kAhrs2 = 178,
  kCameraFeedback = 180,
  kGpsInput = 232,
  kHomePosition = 242,
  kExtendedSysState = 245,
  kStatusText = 253,
  kAirspeed = 295,
  kOdometry = 331,
};

/// Time since the sender's start [ns] as the message states it; empty for messages without one.
/// GPS_RAW_INT is left out: its time is that of the measurement, and UTC with some senders.
[[nodiscard]] std::optional<std::int64_t> boot_time_ns(const Frame& frame);

/// A position on WGS84. The height is above mean sea level.
struct GlobalPosition {
  double lat_deg = 0.0;
  double lon_deg = 0.0;
  double alt_msl_m = 0.0;
};

struct Heartbeat {
  std::uint32_t custom_mode = 0;
  std::uint8_t vehicle_type = 0;  ///< MAV_TYPE
  std::uint8_t autopilot = 0;     ///< MAV_AUTOPILOT
  std::uint8_t base_mode = 0;
  [[nodiscard]] bool armed() const { return (base_mode & 0x80U) != 0; }
  [[nodiscard]] bool is_autopilot() const { return autopilot != kNoAutopilot; }
  /// A fixed-wing aircraft (MAV_TYPE 1) or one that takes off vertically (19 to 25) with ArduPilot.
  [[nodiscard]] bool is_ardu_plane() const {
    return autopilot == kArduPilot &&
           (vehicle_type == 1 || (vehicle_type >= 19 && vehicle_type <= 25));
  }
};
[[nodiscard]] Heartbeat decode_heartbeat(const Frame& frame);

struct SystemTime {
  std::int64_t unix_us = 0;  ///< UTC; 0: unknown
  std::int64_t boot_ns = 0;
};
[[nodiscard]] SystemTime decode_system_time(const Frame& frame);

struct GpsRaw {
  std::uint8_t fix_type = 0;  ///< 3 and above: a fix in three dimensions
  GlobalPosition position;
  std::optional<double> alt_ellipsoid_m;  ///< above WGS84, where it is sent
  std::uint8_t satellites = 0;
};
[[nodiscard]] GpsRaw decode_gps_raw(const Frame& frame);

/// Attitude of ATTITUDE and SIMSTATE, with rates about the body's axes.
struct Attitude {
  RollPitchYaw angles;
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
};
[[nodiscard]] Attitude decode_attitude(const Frame& frame);

struct AttitudeQuaternion {
  Eigen::Quaterniond R_ned_body = Eigen::Quaterniond::Identity();  ///< as sent, not normalised
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
};
[[nodiscard]] AttitudeQuaternion decode_attitude_quaternion(const Frame& frame);

struct LocalPosition {
  Eigen::Vector3d position_ned_m = Eigen::Vector3d::Zero();  ///< from the origin of the estimator
  Eigen::Vector3d velocity_ned_m_s = Eigen::Vector3d::Zero();
};
[[nodiscard]] LocalPosition decode_local_position(const Frame& frame);

struct GlobalPositionVelocity {
  GlobalPosition position;
  Eigen::Vector3d velocity_ned_m_s = Eigen::Vector3d::Zero();
};
[[nodiscard]] GlobalPositionVelocity decode_global_position(const Frame& frame);

[[nodiscard]] GlobalPosition decode_gps_global_origin(const Frame& frame);

/// True state in a simulator: SIM_STATE and HIL_STATE_QUATERNION.
struct SimulatedState {
  GlobalPosition position;
  Eigen::Quaterniond R_ned_body = Eigen::Quaterniond::Identity();  ///< as sent, not normalised
  Eigen::Vector3d velocity_ned_m_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();  ///< about the body's axes
};
/// SIM_STATE. Without its extension fields the position is that of the float fields, which resolve
/// about 1 m: ArduPilot sends 1e-7 deg in them, others degrees.
[[nodiscard]] SimulatedState decode_sim_state(const Frame& frame);
[[nodiscard]] SimulatedState decode_hil_state_quaternion(const Frame& frame);

/// SIMSTATE (ArduPilot): true attitude. It has no height, so it is no position.
[[nodiscard]] Attitude decode_simstate(const Frame& frame);

struct VfrHud {
  double airspeed_m_s = 0.0;
  double groundspeed_m_s = 0.0;
  double alt_msl_m = 0.0;
  double climb_m_s = 0.0;
};
[[nodiscard]] VfrHud decode_vfr_hud(const Frame& frame);

struct Imu {
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();  ///< specific force
};
/// RAW_IMU, SCALED_IMU, SCALED_IMU2, SCALED_IMU3 and HIGHRES_IMU. RAW_IMU is read in the units of
/// SCALED_IMU, as ArduPilot sends it; its definition leaves them open.
[[nodiscard]] Imu decode_imu(const Frame& frame);

struct Ahrs2 {
  RollPitchYaw angles;
  GlobalPosition position;
};
[[nodiscard]] Ahrs2 decode_ahrs2(const Frame& frame);

/// Sequence number of MISSION_CURRENT and MISSION_ITEM_REACHED.
[[nodiscard]] std::uint16_t decode_mission_sequence(const Frame& frame);

struct StatusText {
  std::uint8_t severity = 0;  ///< 0 emergency to 7 debug
  std::string text;
};
[[nodiscard]] StatusText decode_status_text(const Frame& frame);

/// AIRSPEED: indicated airspeed [m/s].
[[nodiscard]] double decode_airspeed_m_s(const Frame& frame);

}  // namespace overfly::flight::mavlink
