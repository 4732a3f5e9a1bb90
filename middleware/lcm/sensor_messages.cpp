#include "middleware/lcm/sensor_messages.hpp"

#include <algorithm>

#include "core/motion/pose.hpp"

namespace overfly::lcm {
namespace {

template <typename Message, typename Sample>
Message timed(const Sample& sample) {
  Message message{};
  message.utime = sample.t_ns / 1000;
  message.t_ns = sample.t_ns;
  return message;
}

}  // namespace

overfly_lcm::imu_t message_of(const ImuSample& sample) {
  auto message = timed<overfly_lcm::imu_t>(sample);
  std::copy_n(sample.angular_rate_rad_s.data(), 3, message.angular_rate);
  std::copy_n(sample.acceleration_m_s2.data(), 3, message.specific_force);
  return message;
}

overfly_lcm::barometer_t message_of(const BarometerSample& sample) {
  auto message = timed<overfly_lcm::barometer_t>(sample);
  message.pressure = sample.pressure_pa;
  message.temperature = sample.temperature_k;
  return message;
}

overfly_lcm::gps_t message_of(const GpsSample& sample) {
  auto message = timed<overfly_lcm::gps_t>(sample);
  message.delivered_ns = sample.delivered_ns;
  message.fix = sample.fix == GpsFixType::k3d ? 3 : 0;
  message.lat_deg = deg_from_rad(sample.place.lat_rad);
  message.lon_deg = deg_from_rad(sample.place.lon_rad);
  message.alt_ellipsoid = sample.place.alt_ellipsoid_m;
  std::copy_n(sample.velocity_ned_m_s.data(), 3, message.velocity_ned);
  message.horizontal_accuracy = sample.horizontal_accuracy_m;
  message.vertical_accuracy = sample.vertical_accuracy_m;
  message.speed_accuracy = sample.speed_accuracy_m_s;
  return message;
}

overfly_lcm::airspeed_t message_of(const AirspeedSample& sample) {
  auto message = timed<overfly_lcm::airspeed_t>(sample);
  message.differential_pressure = sample.differential_pressure_pa;
  message.indicated_airspeed = sample.indicated_airspeed_m_s;
  return message;
}

overfly_lcm::magnetometer_t message_of(const MagnetometerSample& sample) {
  auto message = timed<overfly_lcm::magnetometer_t>(sample);
  std::copy_n(sample.field_ut.data(), 3, message.field_ut);
  return message;
}

overfly_lcm::range_t message_of(const RangeSample& sample) {
  auto message = timed<overfly_lcm::range_t>(sample);
  message.range = sample.range_m;
  return message;
}

}  // namespace overfly::lcm
