// A small fixed-wing aircraft, and where its camera looks.
#pragma once

#include "core/height_query.hpp"
#include "renderer/renderer.hpp"
#include "renderer/scene/scene_triangles.hpp"

namespace overfly::renderer {

/// Draws a high-wing aircraft with its nose along +x, lit, the wings and tail in its colour.
/// @param min_span_px  enlarged to at least this wing span in the image, so that it is not lost
void add_aircraft(const SceneContent::Aircraft& aircraft,
                  double min_span_px,
                  SceneTriangles& triangles);

/// Draws the camera's pyramid down to the ground and the outline of its image there.
void add_frustum(const SceneContent::Frustum& frustum,
                 const HeightQuery& ground,
                 SceneTriangles& triangles);

}  // namespace overfly::renderer
