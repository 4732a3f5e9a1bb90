#include "server/views/view_scene.hpp"

#include <utility>

#include "core/earth/geodesy.hpp"
#include "renderer/ground/ground_ray.hpp"
#include "renderer/viewpoint.hpp"
#include "server/timeline/poses_at.hpp"

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
    case SceneMode::kOnboard:
      return renderer::onboard_viewpoint(
          T_world_body, settings.azimuth_rad, settings.elevation_rad);
    case SceneMode::kFree:
      return renderer::free_viewpoint(settings.eye_world_m,
                                      settings.azimuth_rad,
                                      settings.elevation_rad,
                                      view.min_above_m,
                                      ground);
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

std::vector<renderer::SceneView> scene_views_along(const RunTimeline& timeline,
                                                   const SceneSettings& settings) {
  constexpr unsigned kBits = 8;
  constexpr std::size_t kViews = std::size_t{1} << kBits;
  const bool follows = settings.mode == SceneMode::kChase || settings.mode == SceneMode::kOnboard ||
                       (settings.mode != SceneMode::kFree && settings.follow);
  if (!follows) return {};
  const FlatGround far_below(-1e6);
  const std::size_t count = timeline.frame_count();
  std::vector<renderer::SceneView> views;
  for (std::size_t i = 0; i < kViews; ++i) {
    // The bits of i reversed: 0, 1/2, 1/4, 3/4, 1/8, ... of the flight (van der Corput 1935).
    std::size_t reversed = 0;
    for (unsigned bit = 0; bit < kBits; ++bit) {
      reversed = (reversed << 1U) | ((i >> bit) & 1U);
    }
    for (const FrameRow& row : timeline.frames(reversed * count / kViews, 1)) {
      views.push_back(scene_view(settings, row.T_world_body, Eigen::Vector3d::Zero(), far_below));
    }
  }
  return views;
}

void add_run(const SceneRun& run,
             const SceneShow& show,
             renderer::SceneContent* content,
             std::vector<PlacedLabel>* places) {
  const Eigen::Vector3d p_truth = run.T_scene_world * run.T_world_body.translation;
  // From its aircraft, what coincides with it would fill the view.
  const auto hides_view = [&](const Pose& T_scene_body) {
    constexpr double kNearM = 15.0;
    return run.seen_from && (T_scene_body.translation - p_truth).norm() < kNearM;
  };
  const bool shows_truth = run.look.shows("") && !run.seen_from;
  if (show.aircraft && shows_truth) {
    renderer::SceneContent::Aircraft truth;
    truth.T_world_body = run.T_scene_world * run.T_world_body;
    truth.rgb = run.look.truth_rgb();
    content->aircraft.push_back(truth);
  }
  if (shows_truth) places->push_back({{run.run_id, "", 0.0, 0.0, 0.0, {}}, p_truth});
  const auto& names = run.timeline.estimators();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!run.look.shows(names[i])) continue;
    const auto T_world_body =
        estimate_at(run.timeline, i, run.ribbons.alignment_of(i), run.t_ns).T_world_body;
    if (!T_world_body) continue;
    const Pose T_scene_body = run.T_scene_world * *T_world_body;
    const TrackRgb rgb = run.look.rgb_of(names[i], i);
    if (show.aircraft && !hides_view(T_scene_body)) {
      renderer::SceneContent::Aircraft ghost;
      ghost.T_world_body = T_scene_body;
      ghost.rgb = rgb;
      ghost.ghost = true;
      content->aircraft.push_back(ghost);
    }
    if (show.errors) content->lines.push_back({p_truth, T_scene_body.translation, rgb, 2.5});
    const double error_m = (T_scene_body.translation - p_truth).norm();
    places->push_back({{run.run_id, names[i], 0.0, 0.0, 0.0, error_m}, T_scene_body.translation});
  }
  const auto add_ribbons = [&](std::vector<renderer::Ribbon> ribbons) {
    for (renderer::Ribbon& ribbon : ribbons) {
      std::vector<Pose>& poses = ribbon.T_world_body;
      for (Pose& pose : poses) pose = run.T_scene_world * pose;
      while (!poses.empty() && hides_view(poses.back())) poses.pop_back();
      if (poses.size() > 1) content->ribbons.push_back(std::move(ribbon));
    }
  };
  if (show.ribbons) {
    add_ribbons(run.ribbons.until(run.t_ns, run.T_world_body, run.look));
    if (run.compared != nullptr) add_ribbons(run.compared->dashes_until(run.t_ns, run.look));
  }
  if (show.error_history) {
    constexpr std::size_t kMostLines = 400;
    for (auto line : run.ribbons.errors_until(run.t_ns, run.look, kMostLines)) {
      line.from_world = run.T_scene_world * line.from_world;
      line.to_world = run.T_scene_world * line.to_world;
      content->lines.push_back(line);
    }
  }
}

std::vector<SceneLabel> labels_in_view(const std::vector<PlacedLabel>& places,
                                       const renderer::SceneView& view,
                                       const HeightQuery& ground) {
  constexpr double kClearM = 1.0;
  const auto camera =
      PinholeCamera::from_fov(view.width_px, view.height_px, view.fov_y_rad, FovAxis::kVertical);
  if (!camera) return {};
  const Pose T_camera_world = view.T_world_camera.inverse();
  std::vector<SceneLabel> labels;
  for (const PlacedLabel& place : places) {
    const auto pixel = camera->project(T_camera_world * place.p_world);
    if (!pixel || pixel->x() < 0.0 || pixel->x() > view.width_px - 1.0 || pixel->y() < 0.0 ||
        pixel->y() > view.height_px - 1.0) {
      continue;
    }
    const Eigen::Vector3d sight = place.p_world - view.T_world_camera.translation;
    const double distance_m = sight.norm();
    if (distance_m > kClearM &&
        renderer::cast_to_ground(
            ground, view.T_world_camera.translation, sight / distance_m, distance_m - kClearM)) {
      continue;
    }
    SceneLabel label = place.label;
    label.x_px = pixel->x();
    label.y_px = pixel->y();
    label.distance_m = distance_m;
    labels.push_back(std::move(label));
  }
  return labels;
}

Pose T_world_other(const Geodetic& origin, const Geodetic& other_origin) {
  const LocalFrame world(origin);
  return {world.R_world_enu_at(other_origin), world.world_from_geodetic(other_origin)};
}

}  // namespace overfly::server
