// What a log gives of a flight: positions and attitudes at their own times.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace overfly::flight::smoothing {

/// Times count from a common start [s].
struct PositionSample {
  double t_s = 0.0;
  Eigen::Vector3d p_world_m = Eigen::Vector3d::Zero();  ///< east, north, up
};

struct AttitudeSample {
  double t_s = 0.0;
  Eigen::Quaterniond R_ned_body = Eigen::Quaterniond::Identity();
};

}  // namespace overfly::flight::smoothing
