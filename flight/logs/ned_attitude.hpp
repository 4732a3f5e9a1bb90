// Attitudes relative to north-east-down, as flight logs give them.
#pragma once

#include <Eigen/Geometry>

#include "core/motion/pose.hpp"

namespace overfly::flight::logs {

/// R_ned_body of roll, pitch and yaw.
[[nodiscard]] inline Eigen::Quaterniond R_ned_body_from(const RollPitchYaw& angles) {
  return Eigen::AngleAxisd(angles.yaw_rad, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(angles.pitch_rad, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(angles.roll_rad, Eigen::Vector3d::UnitX());
}

/// From north-east-down to east-north-up: half a turn about the horizontal axis to the north-east.
[[nodiscard]] inline Eigen::Quaterniond R_enu_ned() {
  constexpr double kHalfRoot = 0.70710678118654752440;
  return {0.0, kHalfRoot, kHalfRoot, 0.0};
}

}  // namespace overfly::flight::logs
