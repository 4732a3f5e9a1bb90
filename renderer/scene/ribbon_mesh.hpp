// Trajectories as banked ribbons.
#pragma once

#include "renderer/renderer.hpp"
#include "renderer/scene/scene_triangles.hpp"

namespace overfly::renderer {

/// Draws a ribbon: a translucent strip between the wing tips with solid darker edges, lit from
/// above and darker from below, so that its bank is visible. If it would be narrower in the image
/// than `min_width_px`, a line of that width along its middle is added. Poses that are
/// indistinguishable in the image are merged.
void add_ribbon(const Ribbon& ribbon,
                double min_width_px,
                SceneTriangles& solid,
                SceneTriangles& translucent);

}  // namespace overfly::renderer
