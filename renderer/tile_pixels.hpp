// Tile texels as a texture wants them.
#pragma once

#include <vector>

#include "core/image.hpp"

namespace overfly::renderer {

/// Luma of an RGB image (ITU-R BT.601 weights in 1/256; grey stays exactly as it is).
[[nodiscard]] Image grey_from_rgb(const Image& rgb);

/// RGB with a fourth channel. @param alpha  one channel, of the same size
[[nodiscard]] Image with_alpha(const Image& rgb, const Image& alpha);

/// The image and its halvings (means of 2 x 2 texels, rounded) down to 1 x 1; an odd last column
/// or row is left out, as OpenGL's level sizes do.
[[nodiscard]] std::vector<Image> mip_chain(Image level_0);

}  // namespace overfly::renderer
