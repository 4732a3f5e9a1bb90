// After the definitions of sensor_msgs in common_msgs (ROS 1) and common_interfaces (ROS 2),
// REP-103, REP-117 and REP-145.
#include "flight/logs/ros/ros_sensors.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "core/sensors/measured_samples.hpp"
#include "flight/logs/ros/frame_words.hpp"

namespace overfly::flight::logs {
namespace {

using Covariance = std::array<double, 9>;  ///< 3 x 3, row by row

Eigen::Vector3d take_body_vector(RosCursor& message, std::string_view frame_id) {
  Eigen::Vector3d value;
  for (double& component : value) component = message.number<double>();
  if (!ends_with_word(frame_id, "frd")) value = {value.x(), -value.y(), -value.z()};
  return value;
}

Covariance take_covariance(RosCursor& message) {
  Covariance covariance;
  for (double& element : covariance) element = message.number<double>();
  return covariance;
}

bool is_unknown(const Covariance& covariance) { return covariance[0] == -1.0; }

double deviation_of(double variance) {
  return variance > 0.0 ? std::sqrt(variance) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

SensorSamples take_imu_samples(RosCursor& message, const RosSensorHeader& header) {
  ImuSample sample;
  sample.t_ns = header.stamp_ns;
  sample.angular_rate_rad_s = take_body_vector(message, header.frame_id);
  const bool no_rate = is_unknown(take_covariance(message));
  sample.acceleration_m_s2 = take_body_vector(message, header.frame_id);
  const bool no_force =
      is_unknown(take_covariance(message)) || sample.acceleration_m_s2.isZero(0.0);
  SensorSamples samples;
  if (message.ok() && !no_rate && !no_force) (void)add_measured(samples, sample);
  return samples;
}

SensorSamples take_field_samples(RosCursor& message, const RosSensorHeader& header) {
  constexpr double kUtPerTesla = 1e6;
  MagnetometerSample sample;
  sample.t_ns = header.stamp_ns;
  sample.field_ut = kUtPerTesla * take_body_vector(message, header.frame_id);
  (void)take_covariance(message);
  SensorSamples samples;
  if (message.ok()) (void)add_measured(samples, sample);
  return samples;
}

SensorSamples take_pressure_samples(RosCursor& message, const RosSensorHeader& header) {
  const auto pressure_pa = message.number<double>();
  (void)message.number<double>();  // variance
  SensorSamples samples;
  if (!message.ok()) return samples;
  if (header.is_differential) {
    (void)add_measured(samples, airspeed_of_pressure(header.stamp_ns, pressure_pa));
  } else {
    constexpr double kUnknownK = std::numeric_limits<double>::quiet_NaN();
    (void)add_measured(samples, BarometerSample{header.stamp_ns, pressure_pa, kUnknownK});
  }
  return samples;
}

SensorSamples take_fix_samples(RosCursor& message, const RosSensorHeader& header) {
  const auto status = message.number<std::int8_t>();
  (void)message.number<std::uint16_t>();  // service
  GpsSample sample = gps_without_fix(header.stamp_ns, header.stamp_ns);
  const auto lat_deg = message.number<double>();
  const auto lon_deg = message.number<double>();
  const auto alt_ellipsoid_m = message.number<double>();
  const Covariance east_north_up = take_covariance(message);
  const auto covariance_type = message.number<std::uint8_t>();
  SensorSamples samples;
  if (!message.ok()) return samples;
  if (status >= 0) {
    sample.fix = GpsFixType::k3d;
    sample.place = geodetic_from_deg(lat_deg, lon_deg, alt_ellipsoid_m);
    if (covariance_type != 0) {
      sample.horizontal_accuracy_m = deviation_of(0.5 * (east_north_up[0] + east_north_up[4]));
      sample.vertical_accuracy_m = deviation_of(east_north_up[8]);
    }
  }
  (void)add_measured(samples, sample);
  return samples;
}

SensorSamples take_range_samples(RosCursor& message, const RosSensorHeader& header) {
  (void)message.number<std::uint8_t>();  // radiation_type
  (void)message.number<float>();         // field_of_view
  const auto min_m = message.number<float>();
  const auto max_m = message.number<float>();
  const auto range_m = message.number<float>();
  SensorSamples samples;
  if (!message.ok() || range_m < min_m) return samples;
  const bool echo = !(max_m > 0.0F && range_m > max_m);
  constexpr double kNoEcho = std::numeric_limits<double>::infinity();
  (void)add_measured(samples, RangeSample{header.stamp_ns, echo ? range_m : kNoEcho});
  return samples;
}

}  // namespace overfly::flight::logs
