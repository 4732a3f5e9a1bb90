// Meshes of a small fixed-wing aircraft and of its camera's field of view.
#pragma once

#include "core/earth/height_query.hpp"
#include "renderer/renderer.hpp"
#include "renderer/scene/scene_triangles.hpp"

namespace overfly::renderer {

/// Draws a lit high-wing aircraft with its nose along +x, wings and tail in its colour.
/// @param min_span_px  minimum wing span in the image; a smaller aircraft is enlarged to stay
///                     visible
void add_aircraft(const SceneContent::Aircraft& aircraft,
                  double min_span_px,
                  SceneTriangles& triangles);

/// Draws the camera's pyramid down to the ground and the outline of its image there.
void add_frustum(const SceneContent::Frustum& frustum,
                 const HeightQuery& ground,
                 SceneTriangles& triangles);

}  // namespace overfly::renderer
