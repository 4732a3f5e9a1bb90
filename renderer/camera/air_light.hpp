// The light of the air and of the sky in a camera's pixel formats.
#pragma once

#include <array>

#include "renderer/renderer.hpp"

namespace overfly::renderer {

/// A colour as the imagery encodes it, in the channels and the light of a format: encoded luma or
/// RGB for the 8-bit formats, linear luminance or RGB for the others; 1 = white.
[[nodiscard]] std::array<float, 3> light_in(PixelFormat format,
                                            const std::array<float, 3>& encoded_rgb);

/// What pixels without ground show: the airlight, or in a vacuum a pale blue.
[[nodiscard]] std::array<float, 3> sky_light(const CameraRequest& request);

}  // namespace overfly::renderer
