#include "renderer/ground/view.hpp"

namespace overfly::renderer {

View View::from(const PinholeCamera& camera, const Pose& T_world_camera) {
  View view;
  view.camera = camera;
  view.position_world = T_world_camera.translation;
  view.R_camera_world = T_world_camera.rotation.normalized().toRotationMatrix().transpose();
  return view;
}

namespace {

/// Inward normals of the image's left, right, top and bottom planes in the camera frame. Pixel
/// centres are integers, so that the image spans [-0.5, size - 0.5].
std::array<Eigen::Vector3d, 4> side_normals_camera(const PinholeCamera& camera) {
  return {Eigen::Vector3d(camera.fx_px, 0.0, camera.cx_px + 0.5),
          Eigen::Vector3d(-camera.fx_px, 0.0, camera.width_px - 0.5 - camera.cx_px),
          Eigen::Vector3d(0.0, camera.fy_px, camera.cy_px + 0.5),
          Eigen::Vector3d(0.0, -camera.fy_px, camera.height_px - 0.5 - camera.cy_px)};
}

}  // namespace

unsigned View::outcode(const Eigen::Vector3d& p) const {
  unsigned code = p.z() <= 0.0 ? 16U : 0U;
  const double x = camera.fx_px * p.x();
  const double y = camera.fy_px * p.y();
  if (x + (camera.cx_px + 0.5) * p.z() < 0.0) code |= 1U;
  if ((camera.width_px - 0.5 - camera.cx_px) * p.z() - x < 0.0) code |= 2U;
  if (y + (camera.cy_px + 0.5) * p.z() < 0.0) code |= 4U;
  if ((camera.height_px - 0.5 - camera.cy_px) * p.z() - y < 0.0) code |= 8U;
  return code;
}

std::array<Eigen::Vector3d, 4> View::side_normals_world() const {
  std::array<Eigen::Vector3d, 4> normals = side_normals_camera(camera);
  for (Eigen::Vector3d& normal : normals) normal = R_camera_world.transpose() * normal;
  return normals;
}

Eigen::Vector2d View::pixel_rate(const Eigen::Vector3d& p, const Eigen::Vector3d& d) const {
  const double inverse_z = 1.0 / p.z();
  return {camera.fx_px * (d.x() - p.x() * inverse_z * d.z()) * inverse_z,
          camera.fy_px * (d.y() - p.y() * inverse_z * d.z()) * inverse_z};
}

}  // namespace overfly::renderer
