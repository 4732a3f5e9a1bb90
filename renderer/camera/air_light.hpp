// The light of air and sky in a camera's pixel formats.
#pragma once

#include <array>

#include "renderer/renderer.hpp"

namespace overfly::renderer {

/// Converts a colour in the imagery's encoding to the channels and encoding of a format: encoded
/// luma or RGB for the 8-bit formats, linear luminance or RGB for the others; 1 = white.
[[nodiscard]] std::array<float, 3> light_in(PixelFormat format,
                                            const std::array<float, 3>& encoded_rgb);

/// The colour of pixels without ground: the airlight, or a pale blue if there is no air.
[[nodiscard]] std::array<float, 3> sky_light(const CameraRequest& request);

}  // namespace overfly::renderer
