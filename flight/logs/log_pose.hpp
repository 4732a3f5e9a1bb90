// Poses and attitudes of a flight log.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

namespace overfly::flight::logs {

/// A pose of the aircraft by the vehicle's clock.
struct LogPose {
  std::int64_t t_ns = 0;
  /// Latitude, longitude [deg] and height above the trajectory's datum [m], or north, east, down
  /// [m] from an unknown origin.
  Eigen::Vector3d position;
  Eigen::Quaterniond R_ned_body;  ///< body forward-right-down relative to north-east-down
};

/// An attitude of the aircraft by the vehicle's clock.
struct LogAttitude {
  std::int64_t t_ns = 0;
  Eigen::Quaternionf R_ned_body;  ///< body forward-right-down; not exactly of unit length
};

}  // namespace overfly::flight::logs
