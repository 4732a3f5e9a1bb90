// What the stand-in libraries "see": each knows the camera's path as a function of time, so that
// what an adapter makes of their poses can be compared with it. C++11; needs only Eigen.
#pragma once

#include <Eigen/Geometry>

namespace standins {

/// Depth of every point that they report.
constexpr double kDepth = 2.5;

inline Eigen::Vector3d position_at(double t_s) {
  return {3.0 * t_s, -1.0 - 2.0 * t_s, 0.5 * t_s * t_s};
}

/// Turns by 0.7 rad/s: neither half a turn nor none, so that an inverse cannot pass for itself.
inline Eigen::Quaterniond orientation_at(double t_s) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(0.3 + 0.7 * t_s, Eigen::Vector3d(1, 2, -2) / 3.0));
}

/// What the first pixel of a frame makes a stand-in do.
enum Pixel {
  kDark = 0,           ///< nothing to be seen: tracking fails
  kExit = 251,         ///< calls exit(3), as upstream does on trouble
  kAbort = 252,        ///< fails as an assert does
  kThrowMapAway = 254  ///< starts over by itself
};

}  // namespace standins
