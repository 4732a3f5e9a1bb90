#include "renderer/scene/scene_triangles.hpp"

#include <algorithm>
#include <cmath>

namespace overfly::renderer {

namespace {

constexpr double kNearM = 0.05;

std::uint8_t byte_from(float value) {
  return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F)));
}

}  // namespace

Rgba Rgba::shaded(float factor) const { return {r * factor, g * factor, b * factor, a}; }

float sunlight(const Eigen::Vector3d& normal_world) {
  const Eigen::Vector3d to_sun = Eigen::Vector3d(-0.45, -0.55, 0.7).normalized();
  const double direct = std::max(normal_world.dot(to_sun), 0.0);
  const double sky = 0.5 + 0.5 * normal_world.z();
  return static_cast<float>(std::min(0.28 + 0.24 * sky + 0.56 * direct, 1.0));
}

void SceneTriangles::add_vertex(const Eigen::Vector3d& p, const Rgba& colour) {
  vertices_.push_back(
      {static_cast<float>(scale_ * p.x()),
       static_cast<float>(scale_ * p.y()),
       static_cast<float>(scale_ * p.z()),
       {byte_from(colour.r), byte_from(colour.g), byte_from(colour.b), byte_from(colour.a)}});
}

bool SceneTriangles::outside(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
  return (view_.outcode(a) & view_.outcode(b)) != 0U;
}

void SceneTriangles::add_triangle(const Eigen::Vector3d& a,
                                  const Eigen::Vector3d& b,
                                  const Eigen::Vector3d& c,
                                  const Rgba& colour) {
  if ((view_.outcode(a) & view_.outcode(b) & view_.outcode(c)) != 0U) return;
  add_vertex(a, colour);
  add_vertex(b, colour);
  add_vertex(c, colour);
}

void SceneTriangles::add_line(const Eigen::Vector3d& from,
                              const Eigen::Vector3d& to,
                              double width_px,
                              const Rgba& colour) {
  Eigen::Vector3d a = from;
  Eigen::Vector3d b = to;
  if (outside(a, b)) return;
  // The part in front of the camera.
  if (a.z() < kNearM) std::swap(a, b);
  if (a.z() < kNearM) return;
  if (b.z() < kNearM) b += (a - b) * ((kNearM - b.z()) / (a.z() - b.z()));
  const double f = view_.camera.fy_px;
  const Eigen::Vector2d direction = (b.head<2>() / b.z() - a.head<2>() / a.z());
  const double length = direction.norm();
  if (length <= 0.0) return;
  const Eigen::Vector2d across = Eigen::Vector2d(-direction.y(), direction.x()) / length;
  const Eigen::Vector3d side(across.x() * 0.5 * width_px / f, across.y() * 0.5 * width_px / f, 0.0);
  const Eigen::Vector3d a_left = a + a.z() * side, a_right = a - a.z() * side;
  const Eigen::Vector3d b_left = b + b.z() * side, b_right = b - b.z() * side;
  for (const Eigen::Vector3d& p : {a_left, a_right, b_left, b_left, a_right, b_right}) {
    add_vertex(p, colour);
  }
}

void SceneTriangles::add_mark(const Eigen::Vector3d& p, double size_px, const Rgba& colour) {
  if (view_.outcode(p) != 0U || p.z() < kNearM) return;
  const double r = 0.5 * size_px * p.z() / view_.camera.fy_px;
  const Eigen::Vector3d a = p + Eigen::Vector3d(-r, -r, 0), b = p + Eigen::Vector3d(r, -r, 0);
  const Eigen::Vector3d c = p + Eigen::Vector3d(-r, r, 0), d = p + Eigen::Vector3d(r, r, 0);
  for (const Eigen::Vector3d& corner : {a, b, c, c, b, d}) add_vertex(corner, colour);
}

}  // namespace overfly::renderer
