#include "server/views/images/line_of_sight.hpp"

#include "renderer/ground/ground_ray.hpp"

namespace overfly::server {

std::optional<GroundSight> ground_sight(const renderer::CameraRequest& request,
                                        const Eigen::Vector2d& pixel,
                                        const HeightQuery& ground) {
  constexpr double kMaxRangeM = 100e3;
  const auto ray_camera = request.camera.ray(pixel);
  if (!ray_camera) return std::nullopt;
  const Pose T_world_camera = request.T_world_camera.at(request.row_time_ns(pixel.y()));
  const Eigen::Vector3d ray_world = T_world_camera.rotation * *ray_camera;
  const auto hit = renderer::cast_to_ground(
      ground, T_world_camera.translation, ray_world.normalized(), kMaxRangeM);
  if (!hit) return std::nullopt;
  // A marched hit may lie a centimetre beyond the surface.
  const double length = ray_world.norm();
  const double marched_m = (*hit - T_world_camera.translation).norm() / length;
  const double depth_m =
      renderer::refine_depth(ground, T_world_camera.translation, ray_world, marched_m);
  return GroundSight{T_world_camera.translation + depth_m * ray_world, depth_m, depth_m * length};
}

}  // namespace overfly::server
