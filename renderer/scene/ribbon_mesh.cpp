#include "renderer/scene/ribbon_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace overfly::renderer {

namespace {

constexpr double kStepPx = 3.0;      // wing tips closer than this in the image are merged
constexpr double kEdgeShare = 0.09;  // of the width, on each side
constexpr float kSurfaceAlpha = 0.62F;
/// The ribbon's colour must be recognisable in its own shadow too.
constexpr float kDimmest = 0.7F;

/// One cross-section of the strip, camera frame.
struct Section {
  Eigen::Vector3d left, right;
  Eigen::Vector3d up_world;  ///< the aircraft's up
};

class RibbonBuilder {
 public:
  RibbonBuilder(const Ribbon& ribbon,
                double min_width_px,
                SceneTriangles& solid,
                SceneTriangles& translucent)
      : ribbon_(ribbon), min_width_px_(min_width_px), solid_(solid), translucent_(translucent) {}

  void run() {
    const std::size_t count = ribbon_.T_world_body.size();
    if (count < 2) return;
    Section last = section(ribbon_.T_world_body.front());
    for (std::size_t i = 1; i < count; ++i) {
      const Section next = section(ribbon_.T_world_body[i]);
      if (i + 1 < count && step_px(last, next) < kStepPx) continue;
      add_piece(last, next);
      last = next;
    }
  }

 private:
  [[nodiscard]] Section section(const Pose& T_world_body) const {
    const Eigen::Vector3d half_wing =
        T_world_body.rotation * Eigen::Vector3d(0.0, 0.5 * ribbon_.wing_span_m, 0.0);
    const View& view = solid_.view();
    return {view.camera_from_world(T_world_body.translation - half_wing),
            view.camera_from_world(T_world_body.translation + half_wing),
            T_world_body.rotation * Eigen::Vector3d(0.0, 0.0, -1.0)};
  }

  /// Maximum distance of the wing tips in the image.
  [[nodiscard]] double step_px(const Section& a, const Section& b) const {
    const double moved_m = std::max((a.left - b.left).norm(), (a.right - b.right).norm());
    const double distance_m = std::max(std::min(a.left.norm(), b.left.norm()), 1e-3);
    return solid_.view().camera.fy_px * moved_m / distance_m;
  }

  void add_piece(const Section& a, const Section& b) {
    const Rgba colour{ribbon_.rgb[0], ribbon_.rgb[1], ribbon_.rgb[2], 1.0F};
    const Eigen::Vector3d middle_a = 0.5 * (a.left + a.right);
    const Eigen::Vector3d middle_b = 0.5 * (b.left + b.right);
    // Lit by the sun from above; in its own shadow from below.
    const Eigen::Vector3d up_world = (a.up_world + b.up_world).normalized();
    const Eigen::Vector3d up_camera = solid_.view().R_camera_world * up_world;
    const bool from_above = up_camera.dot(middle_a) < 0.0;
    const float light =
        std::max(kDimmest, from_above ? sunlight(up_world) : 0.8F * sunlight(-up_world));
    add_strip(a, b, 0.0, kEdgeShare, colour.shaded(0.6F * light), solid_);
    Rgba surface = colour.shaded(light);
    surface.a = kSurfaceAlpha;
    add_strip(a, b, kEdgeShare, 1.0 - kEdgeShare, surface, translucent_);
    add_strip(a, b, 1.0 - kEdgeShare, 1.0, colour.shaded(0.6F * light), solid_);
    if (std::min(width_px(a, b), width_px(b, a)) < min_width_px_) {
      solid_.add_line(middle_a, middle_b, min_width_px_, colour);
    }
  }

  void add_strip(const Section& a,
                 const Section& b,
                 double from,
                 double to,
                 const Rgba& colour,
                 SceneTriangles& triangles) {
    const auto across = [](const Section& section, double share) -> Eigen::Vector3d {
      return section.left + share * (section.right - section.left);
    };
    const Eigen::Vector3d a0 = across(a, from), a1 = across(a, to);
    const Eigen::Vector3d b0 = across(b, from), b1 = across(b, to);
    triangles.add_triangle(a0, b0, a1, colour);
    triangles.add_triangle(a1, b0, b1, colour);
  }

  /// Width of the strip in the image at `here`, across its direction there.
  [[nodiscard]] double width_px(const Section& here, const Section& other) const {
    const Eigen::Vector3d middle = 0.5 * (here.left + here.right);
    if (middle.z() < 1.0) return min_width_px_;
    const View& view = solid_.view();
    const Eigen::Vector2d wing = view.pixel_rate(middle, here.right - here.left);
    const Eigen::Vector2d along =
        view.pixel_rate(middle, 0.5 * (other.left + other.right) - middle);
    const double length = along.norm();
    if (length < 1e-9) return wing.norm();
    return std::abs(wing.x() * along.y() - wing.y() * along.x()) / length;
  }

  const Ribbon& ribbon_;
  double min_width_px_;
  SceneTriangles& solid_;
  SceneTriangles& translucent_;
};

}  // namespace

void add_ribbon(const Ribbon& ribbon,
                double min_width_px,
                SceneTriangles& solid,
                SceneTriangles& translucent) {
  RibbonBuilder(ribbon, min_width_px, solid, translucent).run();
}

}  // namespace overfly::renderer
