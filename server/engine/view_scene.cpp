#include "server/engine/view_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace overfly::engine {
namespace {

using Eigen::Vector3d;

/// The viewer stays this far above the ground [m].
constexpr double kClearance = 2.0;
constexpr double kFovY = 0.9;
/// A line of sight steeper than this has no horizon to stand upright by.
constexpr double kSteepest = std::numbers::pi / 2 - 1e-3;

/// Horizontal unit vector of a compass direction.
Vector3d direction(double azimuth_rad) {
  return {std::sin(azimuth_rad), std::cos(azimuth_rad), 0.0};
}

/// A camera at `eye` that looks along `forward`; `top` shows upwards in its image.
Pose look(const Vector3d& eye, const Vector3d& forward, const Vector3d& top) {
  Eigen::Matrix3d R_world_camera;
  R_world_camera.col(2) = forward.normalized();
  R_world_camera.col(0) = forward.cross(top).normalized();
  R_world_camera.col(1) = R_world_camera.col(2).cross(R_world_camera.col(0));
  return {Eigen::Quaterniond(R_world_camera).normalized(), eye};
}

}  // namespace

renderer::SceneView scene_view(const SceneSettings& settings,
                               const Pose& T_world_body,
                               const Vector3d& centre_world,
                               const HeightQuery& ground) {
  const bool chase = settings.mode == SceneMode::kChase;
  const bool top = settings.mode == SceneMode::kTop;
  const Vector3d target = chase || settings.follow ? T_world_body.translation : centre_world;
  double azimuth_rad = settings.azimuth_rad;
  if (chase) azimuth_rad += attitude_from(T_world_body.rotation).yaw_rad + std::numbers::pi;
  const double elevation_rad =
      top ? kSteepest : std::clamp(settings.elevation_rad, -0.2, kSteepest);
  // Seen from above, an azimuth of 0 has north at the top: the viewer stands to the south.
  if (top) azimuth_rad += std::numbers::pi;
  const Vector3d outward = std::cos(elevation_rad) * direction(azimuth_rad) +
                           std::sin(elevation_rad) * Vector3d::UnitZ();
  Vector3d eye = target + settings.distance_m * outward;
  eye.z() = std::max(eye.z(), ground.ground_up_m(eye.x(), eye.y()) + kClearance);

  renderer::SceneView view;
  view.width_px = settings.width_px;
  view.height_px = settings.height_px;
  view.fov_y_rad = kFovY;
  view.T_world_camera = look(eye, target - eye, Vector3d::UnitZ());
  return view;
}

renderer::SceneContent scene_content(const RunTimeline& timeline,
                                     const ViewRibbons& ribbons,
                                     const FrameRow& row,
                                     bool live) {
  renderer::SceneContent content;
  renderer::SceneContent::Aircraft truth;
  truth.T_world_body = row.T_world_body;
  truth.rgb = kTruthRgb;
  content.aircraft.push_back(truth);
  for (std::size_t i = 0; i < timeline.estimators().size(); ++i) {
    const auto estimate = timeline.estimate_at(i, row.t_ns);
    if (estimate && estimate->T_world_body) {
      renderer::SceneContent::Aircraft ghost;
      ghost.T_world_body = *estimate->T_world_body;
      ghost.rgb = estimator_rgb(i);
      ghost.ghost = true;
      content.aircraft.push_back(ghost);
    }
    if (live) {
      const auto points = timeline.live_points(i);
      content.points.insert(content.points.end(), points.begin(), points.end());
    }
  }
  content.frustum = renderer::SceneContent::Frustum{timeline.camera(), row.T_world_camera, true};
  content.ribbons = ribbons.until(row.t_ns, row.T_world_body);
  return content;
}

}  // namespace overfly::engine
