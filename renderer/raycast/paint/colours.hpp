// Colours that do not come from tiles, in the units of a pixel format.
#pragma once

#include <array>

#include "renderer/renderer.hpp"

namespace overfly::renderer::raycast {

/// One value per channel: digital numbers for the 8-bit formats, radiance for the linear ones.
using Colour = std::array<float, 3>;

/// Colours of ground without texels and of the air.
struct SceneColours {
  Colour sky{}, nothing{}, air{};
  static SceneColours of(const CameraRequest& request);
};

}  // namespace overfly::renderer::raycast
