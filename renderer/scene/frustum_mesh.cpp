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

}  // namespace

void add_frustum(const SceneContent::Frustum& frustum,
                 const HeightQuery& ground,
                 SceneTriangles& triangles) {
  const Pose& pose = frustum.T_world_camera;
  const View& view = triangles.view();
  std::vector<std::optional<Eigen::Vector3d>> hits;
  double farthest_m = 0.0;
  for (const Eigen::Vector2d& pixel : border_pixels(frustum.camera)) {
    const Eigen::Vector3d direction = (pose.rotation * frustum.camera.ray(pixel)).normalized();
    hits.push_back(cast_to_ground(ground, pose.translation, direction, kMaxRangeM));
    if (hits.back()) farthest_m = std::max(farthest_m, (*hits.back() - pose.translation).norm());
  }
  const Eigen::Vector3d apex = view.camera_from_world(pose.translation);
  const std::vector<Eigen::Vector2d> pixels = border_pixels(frustum.camera);
  // Rays to the sky are as long as the longest of the others.
  const auto end_of = [&](std::size_t i) -> Eigen::Vector3d {
    if (hits[i]) return view.camera_from_world(*hits[i]);
    const Eigen::Vector3d direction = (pose.rotation * frustum.camera.ray(pixels[i])).normalized();
    return view.camera_from_world(pose.translation + std::max(farthest_m, 100.0) * direction);
  };
  for (std::size_t corner = 0; frustum.edges && corner < 4; ++corner) {
    const Eigen::Vector3d end = end_of(corner * kRaysPerSide);
    triangles.add_line(apex, end, 1.6, kFrustumColour);
    triangles.add_triangle(apex, end, end_of((corner + 1) % 4 * kRaysPerSide), kFaceColour);
  }
  if (!frustum.footprint) return;
  triangles.pull_nearer(0.01);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const auto& next = hits[(i + 1) % hits.size()];
    if (!hits[i] || !next) continue;
    triangles.add_line(
        view.camera_from_world(*hits[i]), view.camera_from_world(*next), 2.4, kFrustumColour);
  }
  triangles.pull_nearer(0.0);
}

}  // namespace overfly::renderer
