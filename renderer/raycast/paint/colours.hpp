// Colours that no tile holds, in the units of a pixel format.
#pragma once

#include <array>

#include "renderer/renderer.hpp"

namespace overfly::renderer::raycast {

/// One value a channel: digital numbers of the 8-bit formats, radiance of the linear ones.
using Colour = std::array<float, 3>;

/// What is painted where there are no texels, and the air before them.
struct SceneColours {
  Colour sky{}, nothing{}, air{};
  static SceneColours of(const CameraRequest& request);
};

}  // namespace overfly::renderer::raycast
