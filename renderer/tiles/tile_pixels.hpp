// Tile texels in the formats of textures.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/camera/image.hpp"

namespace overfly::renderer {

/// Luma of an RGB image (ITU-R BT.601 weights in 1/256; grey is unchanged).
[[nodiscard]] Image grey_from_rgb(const Image& rgb);

/// RGB with a fourth channel. @param alpha  one channel, of the same size
[[nodiscard]] Image with_alpha(const Image& rgb, const Image& alpha);

/// Linear light of the 256 values of an sRGB channel (IEC 61966-2-1), 65535 = 1.0.
[[nodiscard]] const std::array<std::uint16_t, 256>& linear_from_srgb();

/// Relative luminance of an sRGB image in linear light (ITU-R BT.709 weights in 1/65536); of a
/// grey image it is linear_from_srgb() of the grey.
[[nodiscard]] Image16 linear_grey_from_rgb(const Image& rgb);

/// An sRGB image in linear light, with a fourth channel of 0 or 65535.
[[nodiscard]] Image16 linear_with_alpha(const Image& rgb, const Image& alpha);

/// The image and its halvings (means of 2 x 2 texels, rounded) down to 1 x 1; an odd last column or
/// row is dropped, as in OpenGL's level sizes.
[[nodiscard]] std::vector<Image> mip_chain(Image level_0);
[[nodiscard]] std::vector<Image16> mip_chain(Image16 level_0);

}  // namespace overfly::renderer
