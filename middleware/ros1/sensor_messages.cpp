#include "middleware/ros1/sensor_messages.hpp"

#include <cmath>
#include <limits>

#include "core/motion/pose.hpp"

namespace overfly::ros1 {
namespace {

/// Forward-right-down to forward-left-up, or north-east-down to north-west-up.
template <typename Vector>
void set_flu(Vector& to, const Eigen::Vector3d& frd) {
  to.x = frd.x();
  to.y = -frd.y();
  to.z = -frd.z();
}

}  // namespace

ImuMessage message_from(const ImuSample& sample) {
  ImuMessage message;
  message.orientation.w = 1.0;
  message.orientation_covariance[0] = -1.0;  // there is no orientation
  set_flu(message.angular_velocity, sample.angular_rate_rad_s);
  set_flu(message.linear_acceleration, sample.acceleration_m_s2);
  return message;
}

FluidPressureMessage static_pressure_from(const BarometerSample& sample) {
  FluidPressureMessage message;
  message.fluid_pressure = sample.pressure_pa;
  return message;
}

TemperatureMessage temperature_from(const BarometerSample& sample) {
  constexpr double kZeroCelsiusK = 273.15;
  TemperatureMessage message;
  message.temperature = sample.temperature_k - kZeroCelsiusK;
  return message;
}

NavSatFixMessage message_from(const GpsSample& sample) {
  NavSatFixMessage message;
  message.status.service = sensor_msgs::NavSatStatus::SERVICE_GPS;
  message.latitude = deg_from_rad(sample.place.lat_rad);
  message.longitude = deg_from_rad(sample.place.lon_rad);
  message.altitude = sample.place.alt_ellipsoid_m;
  if (sample.fix == GpsFixType::kNone) {
    message.status.status = sensor_msgs::NavSatStatus::STATUS_NO_FIX;
    message.position_covariance_type = NavSatFixMessage::COVARIANCE_TYPE_UNKNOWN;
    return message;
  }
  message.status.status = sensor_msgs::NavSatStatus::STATUS_FIX;
  if (std::isnan(sample.horizontal_accuracy_m) || std::isnan(sample.vertical_accuracy_m)) {
    message.position_covariance_type = NavSatFixMessage::COVARIANCE_TYPE_UNKNOWN;
    return message;
  }
  message.position_covariance_type = NavSatFixMessage::COVARIANCE_TYPE_DIAGONAL_KNOWN;
  const double horizontal = sample.horizontal_accuracy_m * sample.horizontal_accuracy_m;
  message.position_covariance[0] = horizontal;
  message.position_covariance[4] = horizontal;
  message.position_covariance[8] = sample.vertical_accuracy_m * sample.vertical_accuracy_m;
  return message;
}

TwistStampedMessage velocity_from(const GpsSample& sample) {
  const Eigen::Vector3d& ned = sample.velocity_ned_m_s;
  TwistStampedMessage message;
  message.twist.linear.x = ned.y();
  message.twist.linear.y = ned.x();
  message.twist.linear.z = -ned.z();
  return message;
}

FluidPressureMessage differential_pressure_from(const AirspeedSample& sample) {
  FluidPressureMessage message;
  message.fluid_pressure = sample.differential_pressure_pa;
  return message;
}

MagneticFieldMessage message_from(const MagnetometerSample& sample) {
  constexpr double kTeslaPerUt = 1e-6;
  MagneticFieldMessage message;
  set_flu(message.magnetic_field, kTeslaPerUt * sample.field_ut);
  return message;
}

RangeMessage message_from(const RangeSample& sample) {
  RangeMessage message;
  message.radiation_type = RangeMessage::INFRARED;
  message.max_range = std::numeric_limits<float>::infinity();
  message.range = static_cast<float>(sample.range_m);
  return message;
}

}  // namespace overfly::ros1
