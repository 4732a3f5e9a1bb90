#include "renderer/scene/aircraft_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace overfly::renderer {

namespace {

using Eigen::Vector3d;

/// A section of the fuselage; lengths in wing spans, body frame (forward-right-down).
struct FuselageSection {
  double x, z, half_width, half_height;
};

constexpr std::array<FuselageSection, 9> kFuselage{{{0.300, 0.012, 0.004, 0.004},
                                                    {0.292, 0.012, 0.022, 0.022},
                                                    {0.220, 0.010, 0.043, 0.043},
                                                    {0.120, 0.004, 0.052, 0.058},
                                                    {0.040, 0.000, 0.052, 0.062},
                                                    {-0.060, 0.000, 0.046, 0.052},
                                                    {-0.180, -0.008, 0.026, 0.032},
                                                    {-0.340, -0.018, 0.012, 0.018},
                                                    {-0.400, -0.020, 0.004, 0.012}}};

/// A wing or fin: chord line at root and tip, thickness along `normal`.
struct Foil {
  Vector3d root, tip;  ///< leading edges
  double root_chord, tip_chord;
  Vector3d normal;
  double thickness;
};

class AircraftBuilder {
 public:
  AircraftBuilder(const SceneContent::Aircraft& aircraft, double min_span_px, SceneTriangles& out)
      : out_(out), R_world_body_(aircraft.T_world_body.rotation.normalized().toRotationMatrix()) {
    const View& view = out.view();
    centre_camera_ = view.camera_from_world(aircraft.T_world_body.translation);
    R_camera_body_ = view.R_camera_world * R_world_body_;
    const double smallest_m = min_span_px * centre_camera_.norm() / view.camera.fy_px;
    span_m_ = std::max(aircraft.wing_span_m, smallest_m);
    const float alpha = aircraft.ghost ? 0.45F : 1.0F;
    main_ = {aircraft.rgb[0], aircraft.rgb[1], aircraft.rgb[2], alpha};
    body_ = {0.35F * main_.r + 0.65F, 0.35F * main_.g + 0.65F, 0.35F * main_.b + 0.65F, alpha};
    glass_ = {0.10F, 0.14F, 0.20F, alpha};
  }

  void run() {
    add_fuselage();
    const Vector3d down = Vector3d::UnitZ();
    for (const double side : {-1.0, 1.0}) {
      add_foil({{0.105, 0.0, -0.066}, {0.105, 0.36 * side, -0.078}, 0.150, 0.150, down, 0.018},
               main_);
      add_foil(
          {{0.105, 0.36 * side, -0.078}, {0.080, 0.5 * side, -0.083}, 0.150, 0.105, down, 0.014},
          body_);
      add_foil({{-0.320, 0.0, -0.022}, {-0.345, 0.17 * side, -0.022}, 0.095, 0.065, down, 0.008},
               main_);
    }
    add_foil({{-0.300, 0.0, -0.030}, {-0.360, 0.0, -0.160}, 0.110, 0.060, Vector3d::UnitY(), 0.008},
             main_);
    add_propeller();
  }

 private:
  [[nodiscard]] Vector3d camera_point(const Vector3d& p_body) const {
    return centre_camera_ + R_camera_body_ * (span_m_ * p_body);
  }

  /// A lit triangle, visible from both sides.
  void add(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Rgba& colour) {
    const Vector3d normal_body = (b - a).cross(c - a);
    if (normal_body.norm() <= 0.0) return;
    Vector3d normal_world = (R_world_body_ * normal_body).normalized();
    const Vector3d at = camera_point(a);
    if ((R_camera_body_ * normal_body).dot(at) > 0.0) normal_world = -normal_world;
    out_.add_triangle(at, camera_point(b), camera_point(c), colour.shaded(sunlight(normal_world)));
  }

  void add_quad(const Vector3d& a,
                const Vector3d& b,
                const Vector3d& c,
                const Vector3d& d,
                const Rgba& colour) {
    add(a, b, c, colour);
    add(a, c, d, colour);
  }

  void add_fuselage() {
    constexpr int kSides = 12;
    const auto point = [](const FuselageSection& s, int side) -> Vector3d {
      const double angle_rad = 2.0 * kPi * side / kSides;
      return {s.x, s.half_width * std::sin(angle_rad), s.z - s.half_height * std::cos(angle_rad)};
    };
    for (std::size_t i = 0; i + 1 < kFuselage.size(); ++i) {
      for (int side = 0; side < kSides; ++side) {
        // The windscreen and the windows: the upper sides ahead of the wing's centre.
        const bool window = i >= 2 && i <= 3 && (side <= 2 || side >= 9);
        add_quad(point(kFuselage[i], side),
                 point(kFuselage[i], side + 1),
                 point(kFuselage[i + 1], side + 1),
                 point(kFuselage[i + 1], side),
                 window ? glass_ : body_);
      }
    }
  }

  void add_foil(const Foil& foil, const Rgba& colour) {
    // A profile of six points: nose, crest and tail, above and below.
    const auto profile = [&](const Vector3d& lead, double chord) {
      const Vector3d back(-chord, 0.0, 0.0);
      const Vector3d thick = 0.5 * foil.thickness * foil.normal;
      return std::array<Vector3d, 4>{
          lead, lead + 0.3 * back - thick, lead + back, lead + 0.3 * back + thick};
    };
    const auto root = profile(foil.root, foil.root_chord);
    const auto tip = profile(foil.tip, foil.tip_chord);
    for (int i = 0; i < 4; ++i) {
      const int j = (i + 1) % 4;
      add_quad(root[i], root[j], tip[j], tip[i], colour);
    }
    add_quad(tip[0], tip[1], tip[2], tip[3], colour);
  }

  void add_propeller() {
    const Vector3d hub(0.304, 0.0, 0.012);
    const Vector3d blade(0.0, 0.030, 0.085), width(0.0, 0.010, -0.004);
    for (const double side : {-1.0, 1.0}) {
      add_quad(hub,
               hub + side * 0.4 * blade + width,
               hub + side * blade,
               hub + side * 0.4 * blade - width,
               glass_);
    }
  }

  SceneTriangles& out_;
  Eigen::Matrix3d R_world_body_, R_camera_body_;
  Vector3d centre_camera_;
  double span_m_ = 1.0;
  Rgba main_, body_, glass_;
};

}  // namespace

void add_aircraft(const SceneContent::Aircraft& aircraft,
                  double min_span_px,
                  SceneTriangles& triangles) {
  AircraftBuilder(aircraft, min_span_px, triangles).run();
}

}  // namespace overfly::renderer
