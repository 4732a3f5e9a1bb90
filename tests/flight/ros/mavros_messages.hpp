// What MAVROS publishes of a vehicle's MAVLink messages, by its documentation
// (https://wiki.ros.org/mavros: "MAVROS does translate aerospace NED frames, used in FCUs to ROS
// ENU frames and vice-versa. For translate airframe related data we simply apply rotation 180 about
// ROLL (X) axis. For local we apply 180 about ROLL (X) and 90 about YAW (Z) axes"), REP-103 and
// REP-105. Written out in components, apart from the program's own changes of axes.
#pragma once

#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/MagneticField.h>
#include <sensor_msgs/NavSatFix.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "flight/mavlink/messages.hpp"
#include "flight/mavlink/payload.hpp"
#include "middleware/ros1/messages.hpp"
#include "middleware/ros1/types.hpp"
#include "tests/flight/mavlink/replay_vehicle.hpp"

namespace overfly::flight::testing {

using FixMessage = sensor_msgs::NavSatFix_<ros1::MessageAllocator>;
using FieldMessage = sensor_msgs::MagneticField_<ros1::MessageAllocator>;
using PressureMessage = sensor_msgs::FluidPressure_<ros1::MessageAllocator>;
using ImuMessage = sensor_msgs::Imu_<ros1::MessageAllocator>;

/// Unix time of the vehicle's start, which MAVROS knows from TIMESYNC.
inline constexpr std::int64_t kBootUnixNs = 1'700'000'000'250'000'000;
/// Height of the geoid above the ellipsoid, which MAVROS adds (EGM96).
inline constexpr double kSitlGeoidM = 19.3;

inline ros::Time stamp_of(std::int64_t boot_ns) {
  return ros1::time_from_ns(kBootUnixNs + boot_ns);
}

/// R_enu_flu: rows east, north, up are those of north, east, down as E, N, -D; columns forward,
/// left, up are those of forward, right, down as F, -R, -D.
inline Eigen::Quaterniond enu_flu_from(const Eigen::Quaterniond& R_ned_frd) {
  const Eigen::Matrix3d R = R_ned_frd.normalized().toRotationMatrix();
  Eigen::Matrix3d out;
  out << R(1, 0), -R(1, 1), -R(1, 2),  //
      R(0, 0), -R(0, 1), -R(0, 2),     //
      -R(2, 0), R(2, 1), R(2, 2);
  return Eigen::Quaterniond(out);
}

template <typename Orientation>
void put_orientation(const Eigen::Quaterniond& R, Orientation& orientation) {
  orientation.w = R.w();
  orientation.x = R.x();
  orientation.y = R.y();
  orientation.z = R.z();
}

/// /mavros/global_position/global of GLOBAL_POSITION_INT.
inline FixMessage fix_of(const mavlink::Frame& frame) {
  const mavlink::GlobalPosition position = mavlink::decode_global_position(frame).position;
  FixMessage fix;
  fix.header.stamp = stamp_of(*mavlink::boot_time_ns(frame));
  fix.header.frame_id = "base_link";
  fix.latitude = position.lat_deg;
  fix.longitude = position.lon_deg;
  fix.altitude = position.alt_msl_m + kSitlGeoidM;
  return fix;
}

/// /mavros/imu/data_raw of RAW_IMU, of which ArduPilot sends milli-g and mrad/s; by its definition
/// 8 bytes of time in microseconds, then three times int16_t acceleration, rate, field.
inline ImuMessage raw_imu_of(const mavlink::Frame& frame) {
  const mavlink::PayloadReader payload(frame.payload);
  ImuMessage imu;
  imu.header.stamp = stamp_of(static_cast<std::int64_t>(payload.at<std::uint64_t>(0)) * 1000);
  imu.header.frame_id = "base_link";
  imu.orientation_covariance[0] = -1.0;
  imu.linear_acceleration.x = payload.at<std::int16_t>(8) * 9.80665e-3;
  imu.linear_acceleration.y = -payload.at<std::int16_t>(10) * 9.80665e-3;
  imu.linear_acceleration.z = -payload.at<std::int16_t>(12) * 9.80665e-3;
  imu.angular_velocity.x = payload.at<std::int16_t>(14) * 1e-3;
  imu.angular_velocity.y = -payload.at<std::int16_t>(16) * 1e-3;
  imu.angular_velocity.z = -payload.at<std::int16_t>(18) * 1e-3;
  return imu;
}

/// /mavros/imu/mag: milligauss, 1e-7 T.
inline FieldMessage field_of(const mavlink::Frame& frame) {
  const mavlink::PayloadReader payload(frame.payload);
  FieldMessage field;
  field.header = raw_imu_of(frame).header;
  field.magnetic_field.x = payload.at<std::int16_t>(20) * 1e-7;
  field.magnetic_field.y = -payload.at<std::int16_t>(22) * 1e-7;
  field.magnetic_field.z = -payload.at<std::int16_t>(24) * 1e-7;
  return field;
}

/// /mavros/imu/static_pressure of SCALED_PRESSURE: milliseconds, then hPa.
inline PressureMessage pressure_of(const mavlink::Frame& frame) {
  const mavlink::PayloadReader payload(frame.payload);
  PressureMessage pressure;
  pressure.header.stamp = stamp_of(std::int64_t{payload.at<std::uint32_t>(0)} * 1'000'000);
  pressure.header.frame_id = "base_link";
  pressure.fluid_pressure = 100.0 * payload.at<float>(4);
  return pressure;
}

/// /mavros/imu/data of ATTITUDE_QUATERNION; its accelerations are not needed here.
inline ImuMessage imu_of(const mavlink::Frame& frame) {
  const mavlink::AttitudeQuaternion attitude = mavlink::decode_attitude_quaternion(frame);
  ImuMessage imu;
  imu.header.stamp = stamp_of(*mavlink::boot_time_ns(frame));
  imu.header.frame_id = "base_link";
  put_orientation(enu_flu_from(attitude.R_ned_body), imu.orientation);
  imu.angular_velocity.x = attitude.rate_rad_s.x();
  imu.angular_velocity.y = -attitude.rate_rad_s.y();
  imu.angular_velocity.z = -attitude.rate_rad_s.z();
  return imu;
}

/// /mavros/local_position/pose of LOCAL_POSITION_NED, with the latest attitude.
inline ros1::PoseStampedMessage pose_of(const mavlink::Frame& frame,
                                        const Eigen::Quaterniond& R_ned_frd) {
  const Eigen::Vector3d ned = mavlink::decode_local_position(frame).position_ned_m;
  ros1::PoseStampedMessage pose;
  pose.header.stamp = stamp_of(*mavlink::boot_time_ns(frame));
  pose.header.frame_id = "map";
  pose.pose.position.x = ned.y();
  pose.pose.position.y = ned.x();
  pose.pose.position.z = -ned.z();
  put_orientation(enu_flu_from(R_ned_frd), pose.pose.orientation);
  return pose;
}

/// What takes the messages.
struct MavrosTopics {
  std::function<void(const FixMessage&)> global;
  std::function<void(const ImuMessage&)> imu;
  std::function<void(const ros1::PoseStampedMessage&)> pose;
  /// What the sensors measure; may be empty.
  std::function<void(const ImuMessage&)> raw_imu;
  std::function<void(const FieldMessage&)> field;
  std::function<void(const PressureMessage&)> pressure;
};

/// Passes on the messages of a recording within [from_ms, to_ms) of the vehicle's clock.
inline void publish_recording(const std::filesystem::path& tlog,
                              std::int64_t from_ms,
                              std::int64_t to_ms,
                              const MavrosTopics& topics) {
  using mavlink::MessageId;
  std::optional<Eigen::Quaterniond> attitude;
  bool begun = false;
  for_each_frame(tlog, [&](const mavlink::Frame& frame, std::span<const std::uint8_t>) {
    if (begun && topics.pressure && frame.component == 1 &&
        static_cast<MessageId>(frame.message_id) == MessageId::kScaledPressure) {
      topics.pressure(pressure_of(frame));
      return true;
    }
    const std::optional<std::int64_t> boot_ns = mavlink::boot_time_ns(frame);
    if (frame.component != 1 || !boot_ns || *boot_ns < from_ms * 1'000'000) return true;
    if (*boot_ns >= to_ms * 1'000'000) return false;
    begun = true;
    switch (static_cast<MessageId>(frame.message_id)) {
      case MessageId::kGlobalPositionInt:
        topics.global(fix_of(frame));
        break;
      case MessageId::kAttitudeQuaternion:
        attitude = mavlink::decode_attitude_quaternion(frame).R_ned_body;
        topics.imu(imu_of(frame));
        break;
      case MessageId::kLocalPositionNed:
        if (attitude) topics.pose(pose_of(frame, *attitude));
        break;
      case MessageId::kRawImu:
        if (topics.raw_imu) topics.raw_imu(raw_imu_of(frame));
        if (topics.field) topics.field(field_of(frame));
        break;
      default:
        break;
    }
    return true;
  });
}

}  // namespace overfly::flight::testing
