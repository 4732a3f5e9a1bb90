#include "server/views/view_scene.hpp"

#include <utility>

#include "core/earth/geodesy.hpp"
#include "renderer/viewpoint.hpp"

namespace overfly::server {
namespace {

constexpr double kFovY = 0.9;

Pose viewpoint(const SceneSettings& settings,
               const Pose& T_world_body,
               const Eigen::Vector3d& centre_world,
               const HeightQuery& ground) {
  renderer::Viewpoint view;
  view.azimuth_rad = settings.azimuth_rad;
  view.elevation_rad = settings.elevation_rad;
  view.distance_m = settings.distance_m;
  const Eigen::Vector3d target = settings.follow ? T_world_body.translation : centre_world;
  switch (settings.mode) {
    case SceneMode::kChase:
      return renderer::chase_viewpoint(T_world_body, view, ground);
    case SceneMode::kOrbit:
      return renderer::orbit_viewpoint(target, view, ground);
    case SceneMode::kTop:
      break;
  }
  return renderer::top_viewpoint(target, settings.azimuth_rad, settings.distance_m);
}

}  // namespace

renderer::SceneView scene_view(const SceneSettings& settings,
                               const Pose& T_world_body,
                               const Eigen::Vector3d& centre_world,
                               const HeightQuery& ground) {
  renderer::SceneView view;
  view.width_px = settings.width_px;
  view.height_px = settings.height_px;
  view.fov_y_rad = kFovY;
  view.T_world_camera = viewpoint(settings, T_world_body, centre_world, ground);
  return view;
}

renderer::SceneContent scene_content(const RunTimeline& timeline,
                                     const ViewRibbons& ribbons,
                                     const FrameRow& row,
                                     std::vector<Eigen::Vector3f> map_points_world,
                                     std::size_t first_colour) {
  renderer::SceneContent content;
  add_other_run(timeline, ribbons, row, Pose{}, first_colour, &content);
  content.points = std::move(map_points_world);
  const PinholeCamera camera = timeline.main_camera().model.pinhole();
  content.frustum = renderer::SceneContent::Frustum{camera, row.T_world_camera, true};
  return content;
}

void add_other_run(const RunTimeline& timeline,
                   const ViewRibbons& ribbons,
                   const FrameRow& row,
                   const Pose& T_world_other,
                   std::size_t first_colour,
                   renderer::SceneContent* content) {
  renderer::SceneContent::Aircraft truth;
  truth.T_world_body = T_world_other * row.T_world_body;
  truth.rgb = kTruthRgb;
  content->aircraft.push_back(truth);
  for (std::size_t i = 0; i < timeline.estimators().size(); ++i) {
    const auto estimate = timeline.estimate_at(i, row.t_ns);
    const auto T_other_body = estimate ? ribbons.T_world_body(i, *estimate) : std::nullopt;
    if (!T_other_body) continue;
    renderer::SceneContent::Aircraft ghost;
    ghost.T_world_body = T_world_other * *T_other_body;
    ghost.rgb = estimator_rgb(first_colour + i);
    ghost.ghost = true;
    content->aircraft.push_back(ghost);
  }
  for (renderer::Ribbon& ribbon : ribbons.until(row.t_ns, row.T_world_body, first_colour)) {
    for (Pose& pose : ribbon.T_world_body) pose = T_world_other * pose;
    content->ribbons.push_back(std::move(ribbon));
  }
}

Pose T_world_other(const Geodetic& origin, const Geodetic& other_origin) {
  const LocalFrame world(origin);
  return {world.R_world_enu_at(other_origin), world.world_from_geodetic(other_origin)};
}

}  // namespace overfly::server
