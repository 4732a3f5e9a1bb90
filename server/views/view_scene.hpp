// The scene view of a run at an instant: its viewpoint and its contents.
#pragma once

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
[[nodiscard]] renderer::SceneContent scene_content(const RunTimeline& timeline,
                                                   const ViewRibbons& ribbons,
                                                   const FrameRow& row,
                                                   std::vector<Eigen::Vector3f> map_points_world);

}  // namespace overfly::server
