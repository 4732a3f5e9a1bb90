#include "renderer/viewpoint.hpp"

#include <algorithm>
#include <cmath>

namespace overfly::renderer {

namespace {

Eigen::Vector3d level_direction(double azimuth_rad) {
  return {std::sin(azimuth_rad), std::cos(azimuth_rad), 0.0};
}

}  // namespace

Pose look_at(const Eigen::Vector3d& eye_world,
             const Eigen::Vector3d& target_world,
             const Eigen::Vector3d& up_world) {
  const Eigen::Vector3d forward = (target_world - eye_world).normalized();
  Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ());
  if (right.norm() < 1e-3) right = forward.cross(up_world);
  right.normalize();
  Eigen::Matrix3d R_world_camera;
  R_world_camera << right, forward.cross(right), forward;
  return {Eigen::Quaterniond(R_world_camera).normalized(), eye_world};
}

Pose orbit_viewpoint(const Eigen::Vector3d& target_world,
                     const Viewpoint& view,
                     const HeightQuery& ground) {
  const Eigen::Vector3d outward = std::cos(view.elevation_rad) * level_direction(view.azimuth_rad) +
                                  std::sin(view.elevation_rad) * Eigen::Vector3d::UnitZ();
  Eigen::Vector3d eye = target_world + view.distance_m * outward;
  eye.z() = std::max(eye.z(), ground.ground_up_m(eye.x(), eye.y()) + view.min_above_m);
  // Straight down, the image's top lies ahead of the viewer; straight up, behind.
  const double ahead = eye.z() >= target_world.z() ? -1.0 : 1.0;
  return look_at(eye, target_world, ahead * level_direction(view.azimuth_rad));
}

Pose chase_viewpoint(const Pose& T_world_body, const Viewpoint& view, const HeightQuery& ground) {
  Viewpoint compass = view;
  compass.azimuth_rad += attitude_from(T_world_body.rotation).yaw_rad + kPi;
  return orbit_viewpoint(T_world_body.translation, compass, ground);
}

Pose onboard_viewpoint(const Pose& T_world_body, double azimuth_rad, double elevation_rad) {
  constexpr double kAboveM = 1.0;
  // Body axes: x forward, y right, z down.
  const Eigen::AngleAxisd turned(azimuth_rad, Eigen::Vector3d::UnitZ());
  const Eigen::AngleAxisd raised(elevation_rad, Eigen::Vector3d::UnitY());
  Eigen::Matrix3d R_head_camera;  // columns: right, down, forward
  R_head_camera << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  const Eigen::Quaterniond R_body_camera(Eigen::Matrix3d(turned * raised * R_head_camera));
  return {(T_world_body.rotation * R_body_camera).normalized(),
          T_world_body * Eigen::Vector3d(0.0, 0.0, -kAboveM)};
}

Pose free_viewpoint(const Eigen::Vector3d& eye_world,
                    double azimuth_rad,
                    double elevation_rad,
                    double min_above_m,
                    const HeightQuery& ground) {
  Eigen::Vector3d eye = eye_world;
  eye.z() = std::max(eye.z(), ground.ground_up_m(eye.x(), eye.y()) + min_above_m);
  const Eigen::Vector3d level = level_direction(azimuth_rad);
  const Eigen::Vector3d ahead =
      std::cos(elevation_rad) * level + std::sin(elevation_rad) * Eigen::Vector3d::UnitZ();
  const double up = elevation_rad <= 0.0 ? 1.0 : -1.0;
  return look_at(eye, eye + ahead, up * level);
}

Pose top_viewpoint(const Eigen::Vector3d& target_world, double up_azimuth_rad, double distance_m) {
  return look_at(target_world + distance_m * Eigen::Vector3d::UnitZ(),
                 target_world,
                 level_direction(up_azimuth_rad));
}

}  // namespace overfly::renderer
