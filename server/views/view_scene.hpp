// The scene view of a run at an instant: its viewpoint and its contents.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/earth/geodesy.hpp"
#include "core/earth/height_query.hpp"
#include "renderer/renderer.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/views/picture_request.hpp"
#include "server/views/view_ribbons.hpp"

namespace overfly::server {

/// A label at a place of the scene.
struct PlacedLabel {
  SceneLabel label;
  Eigen::Vector3d p_world;
};

/// The viewpoint.
/// @param T_world_body  of the aircraft
/// @param centre_world  of the trajectory, for a view that does not follow the aircraft
/// @param ground  keeps the viewpoint above the ground
[[nodiscard]] renderer::SceneView scene_view(const SceneSettings& settings,
                                             const Pose& T_world_body,
                                             const Eigen::Vector3d& centre_world,
                                             const HeightQuery& ground);

/// Views along a whole flight, for a viewpoint that follows the aircraft: those far apart first, at
/// most a few hundred. Not kept above the ground. Empty for other viewpoints.
[[nodiscard]] std::vector<renderer::SceneView> scene_views_along(const RunTimeline& timeline,
                                                                 const SceneSettings& settings);

/// A run in a scene.
struct SceneRun {
  std::string run_id;
  const RunTimeline& timeline;
  const ViewRibbons& ribbons;
  const ViewRibbons* compared;  ///< under a second alignment, drawn as dashes; null = none
  std::int64_t t_ns;            ///< of the run
  Pose T_world_body;            ///< the true one at this time
  TrackLook look;
  Pose T_scene_world;      ///< its world frame in that of the scene
  bool seen_from = false;  ///< the viewpoint is in its aircraft, which is therefore not shown
};

/// Adds aircraft, ribbons, estimates and error lines.
/// @param places  gets where the labels of the aircraft belong; without pixels
void add_run(const SceneRun& run,
             const SceneShow& show,
             renderer::SceneContent* content,
             std::vector<PlacedLabel>* places);

/// The labels that lie in the view and are not hidden by the ground.
[[nodiscard]] std::vector<SceneLabel> labels_in_view(const std::vector<PlacedLabel>& places,
                                                     const renderer::SceneView& view,
                                                     const HeightQuery& ground);

/// The world frame of one run in that of another.
[[nodiscard]] Pose T_world_other(const Geodetic& origin, const Geodetic& other_origin);

}  // namespace overfly::server
