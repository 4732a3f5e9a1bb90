// Depth from two views.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/motion/pose.hpp"

namespace overfly::odometry {

struct TriangulatedPoint {
  Eigen::Vector3d p_first = Eigen::Vector3d::Zero();  ///< in the first camera
  double parallax_rad = 0.0;                          ///< angle between the two rays
};

/// The point on the first ray that is closest to the second ray's direction.
///
/// Method: with X2 = R z1 r1 + t parallel to r2, (R r1 x r2) z1 = -(t x r2), by least squares.
/// @param ray_first, ray_second  directions with z = 1
/// @return empty if the rays are parallel or the point is behind a camera
[[nodiscard]] inline std::optional<TriangulatedPoint> triangulate(const Eigen::Vector3d& ray_first,
                                                                  const Eigen::Vector3d& ray_second,
                                                                  const Pose& T_second_first) {
  const Eigen::Vector3d turned = T_second_first.rotation * ray_first;
  const Eigen::Vector3d normal = turned.cross(ray_second);
  const double square = normal.squaredNorm();
  if (square < 1e-14) return std::nullopt;
  const double depth = -normal.dot(T_second_first.translation.cross(ray_second)) / square;
  if (depth <= 0.0 || depth * turned.z() + T_second_first.translation.z() <= 0.0) {
    return std::nullopt;
  }
  const double sine = normal.norm() / (turned.norm() * ray_second.norm());
  return TriangulatedPoint{depth * ray_first, std::asin(std::min(1.0, sine))};
}

}  // namespace overfly::odometry
