// The objects that a scene view draws over the ground: coloured triangles in the camera frame.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "renderer/ground/view.hpp"

namespace overfly::renderer {

struct Rgba {
  float r = 1.0F, g = 1.0F, b = 1.0F, a = 1.0F;

  /// The colour with its brightness scaled.
  [[nodiscard]] Rgba shaded(float factor) const;
};

struct SceneVertex {
  float x = 0.0F, y = 0.0F, z = 0.0F;  ///< camera frame [m]
  std::array<std::uint8_t, 4> rgba{};
};

/// Collects triangles, three vertices each. Points may be behind the camera.
class SceneTriangles {
 public:
  explicit SceneTriangles(const View& view) : view_(view) {}

  /// Moves the following triangles closer to the camera by this share of their distance: their
  /// position in the image is unchanged, and they are drawn over the surface on which they lie.
  void pull_nearer(double share) { scale_ = 1.0 - share; }

  void add_triangle(const Eigen::Vector3d& a_camera,
                    const Eigen::Vector3d& b_camera,
                    const Eigen::Vector3d& c_camera,
                    const Rgba& colour);
  /// A line of constant width in the image, independent of distance.
  void add_line(const Eigen::Vector3d& from_camera,
                const Eigen::Vector3d& to_camera,
                double width_px,
                const Rgba& colour);
  /// A square mark of constant size in the image.
  void add_mark(const Eigen::Vector3d& p_camera, double size_px, const Rgba& colour);

  [[nodiscard]] const View& view() const { return view_; }
  [[nodiscard]] const std::vector<SceneVertex>& vertices() const { return vertices_; }

 private:
  void add_vertex(const Eigen::Vector3d& p_camera, const Rgba& colour);
  [[nodiscard]] bool outside(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;

  View view_;
  double scale_ = 1.0;
  std::vector<SceneVertex> vertices_;
};

/// Brightness of a surface in the scene's sunlight, in [0, 1].
/// @param normal_world  unit vector towards the visible side
[[nodiscard]] float sunlight(const Eigen::Vector3d& normal_world);

}  // namespace overfly::renderer
