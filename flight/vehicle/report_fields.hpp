// Fields of messages from a vehicle's report. Private to vehicle.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "flight/mavlink/payload.hpp"
#include "flight/vehicle/reported_state.hpp"

namespace overfly::vehicle {

/// Rounded and limited to the range of the field.
template <typename T>
T field(double value) {
  constexpr double kLow = std::numeric_limits<T>::lowest();
  constexpr double kHigh = std::numeric_limits<T>::max();
  return static_cast<T>(std::clamp(std::round(value), kLow, kHigh));
}

inline std::uint32_t boot_ms(const VehicleReport& report) {
  return static_cast<std::uint32_t>(report.boot_ns / 1'000'000);
}

/// North, east, down of an east-north-up vector.
inline Eigen::Vector3f ned(const Eigen::Vector3d& enu) {
  return Eigen::Vector3d(enu.y(), enu.x(), -enu.z()).cast<float>();
}

/// Attitude relative to the local north-east-down.
inline Eigen::Quaterniond R_ned_body(const VehicleReport& report) {
  const auto& angles = report.state.attitude;
  return Eigen::AngleAxisd(angles.yaw_rad, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(angles.pitch_rad, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(angles.roll_rad, Eigen::Vector3d::UnitX());
}

inline void put_rates(flight::mavlink::PayloadWriter& payload,
                      std::size_t at,
                      const VehicleReport& report) {
  for (int i = 0; i < 3; ++i) {
    payload.put(at + 4 * static_cast<std::size_t>(i),
                static_cast<float>(report.state.omega_body_rad_s[i]));
  }
}

inline void put_vector(flight::mavlink::PayloadWriter& payload,
                       std::size_t at,
                       const Eigen::Vector3f& vector) {
  for (int i = 0; i < 3; ++i) payload.put(at + 4 * static_cast<std::size_t>(i), vector[i]);
}

}  // namespace overfly::vehicle
