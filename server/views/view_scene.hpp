// The scene view of a run at an instant: its viewpoint and its contents.
#pragma once

#include "core/earth/geodesy.hpp"
#include "core/earth/height_query.hpp"
#include "renderer/renderer.hpp"
#include "server/timeline/run_timeline.hpp"
#include "server/views/picture_request.hpp"
#include "server/views/view_ribbons.hpp"

namespace overfly::server {

/// The viewpoint.
/// @param T_world_body  of the aircraft
/// @param centre_world  of the trajectory, for a view that does not follow the aircraft
/// @param ground  keeps the viewpoint above the ground
[[nodiscard]] renderer::SceneView scene_view(const SceneSettings& settings,
                                             const Pose& T_world_body,
                                             const Eigen::Vector3d& centre_world,
                                             const HeightQuery& ground);

/// Aircraft, frustum, ribbons and estimates at the frame `row`.
/// @param map_points_world  shown with them
/// @param first_colour  index of the first estimator's colour
[[nodiscard]] renderer::SceneContent scene_content(const RunTimeline& timeline,
                                                   const ViewRibbons& ribbons,
                                                   const FrameRow& row,
                                                   std::vector<Eigen::Vector3f> map_points_world,
                                                   std::size_t first_colour);

/// Adds aircraft, ribbons and estimates of another run at its frame `row`.
/// @param T_world_other  its world frame in that of the scene
void add_other_run(const RunTimeline& timeline,
                   const ViewRibbons& ribbons,
                   const FrameRow& row,
                   const Pose& T_world_other,
                   std::size_t first_colour,
                   renderer::SceneContent* content);

/// The world frame of one run in that of another.
[[nodiscard]] Pose T_world_other(const Geodetic& origin, const Geodetic& other_origin);

}  // namespace overfly::server
