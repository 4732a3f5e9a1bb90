#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "renderer/ground/ground_ray.hpp"
#include "renderer/scene/aircraft_mesh.hpp"

namespace overfly::renderer {

namespace {

constexpr int kRaysPerSide = 16;
constexpr double kMaxRangeM = 20e3;
constexpr Rgba kFrustumColour{1.0F, 0.85F, 0.25F, 0.9F};
constexpr Rgba kFaceColour{1.0F, 0.9F, 0.4F, 0.10F};

/// The image's border as pixels, corner by corner, kRaysPerSide per side.
std::vector<Eigen::Vector2d> border_pixels(const PinholeCamera& camera) {
  const double right = camera.width_px - 0.5;
  const double bottom = camera.height_px - 0.5;
  const std::array<Eigen::Vector2d, 5> corners{
      {{-0.5, -0.5}, {right, -0.5}, {right, bottom}, {-0.5, bottom}, {-0.5, -0.5}}};
  std::vector<Eigen::Vector2d> pixels;
  for (int side = 0; side < 4; ++side) {
    for (int i = 0; i < kRaysPerSide; ++i) {
      const double share = static_cast<double>(i) / kRaysPerSide;
      pixels.emplace_back((1.0 - share) * corners[side] + share * corners[side + 1]);
    }
  }
  return pixels;
}

struct BorderRay {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  // world frame, unit length
  std::optional<Eigen::Vector3d> ground;                // where it meets the ground, world frame
};

/// The rays of border_pixels(); empty where the lens has none.
std::vector<std::optional<BorderRay>> border_rays(const SceneContent::Frustum& frustum,
                                                  const HeightQuery& ground) {
  const Pose& pose = frustum.T_world_camera;
  std::vector<std::optional<BorderRay>> rays;
  for (const Eigen::Vector2d& pixel : border_pixels(frustum.camera.pinhole())) {
    std::optional<BorderRay>& ray = rays.emplace_back();
    const std::optional<Eigen::Vector3d> seen = frustum.camera.ray(pixel);
    if (!seen) continue;
    const Eigen::Vector3d direction = (pose.rotation * *seen).normalized();
    ray = {direction, cast_to_ground(ground, pose.translation, direction, kMaxRangeM)};
  }
  return rays;
}

void add_edges(const Pose& T_world_camera,
               const std::vector<std::optional<BorderRay>>& rays,
               int rays_per_face,
               SceneTriangles& triangles) {
  const View& view = triangles.view();
  const Eigen::Vector3d& apex_world = T_world_camera.translation;
  const Eigen::Vector3d apex = view.camera_from_world(apex_world);
  double farthest_m = 0.0;
  for (const auto& ray : rays) {
    if (ray && ray->ground) farthest_m = std::max(farthest_m, (*ray->ground - apex_world).norm());
  }
  // Rays to the sky are as long as the longest of the others.
  const auto end_of = [&](const BorderRay& ray) -> Eigen::Vector3d {
    if (ray.ground) return view.camera_from_world(*ray.ground);
    return view.camera_from_world(apex_world + std::max(farthest_m, 100.0) * ray.direction);
  };
  for (std::size_t i = 0; i < rays.size(); i += rays_per_face) {
    const auto& next = rays[(i + rays_per_face) % rays.size()];
    if (!rays[i]) continue;
    const Eigen::Vector3d end = end_of(*rays[i]);
    if (i % kRaysPerSide == 0) triangles.add_line(apex, end, 1.6, kFrustumColour);
    if (next) triangles.add_triangle(apex, end, end_of(*next), kFaceColour);
  }
}

}  // namespace

void add_frustum(const SceneContent::Frustum& frustum,
                 const HeightQuery& ground,
                 SceneTriangles& triangles) {
  const View& view = triangles.view();
  const std::vector<std::optional<BorderRay>> rays = border_rays(frustum, ground);
  if (frustum.edges) {
    // The rays of a side lie in a plane, unless a lens bends them.
    const int rays_per_face = frustum.camera.distortion().none() ? kRaysPerSide : 1;
    add_edges(frustum.T_world_camera, rays, rays_per_face, triangles);
  }
  if (!frustum.footprint) return;
  triangles.pull_nearer(0.01);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto& here = rays[i];
    const auto& next = rays[(i + 1) % rays.size()];
    if (!here || !next || !here->ground || !next->ground) continue;
    triangles.add_line(view.camera_from_world(*here->ground),
                       view.camera_from_world(*next->ground),
                       2.4,
                       kFrustumColour);
  }
  triangles.pull_nearer(0.0);
}

}  // namespace overfly::renderer
