// Tile texels in the formats of textures, with their mip levels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/camera/image.hpp"
#include "renderer/renderer.hpp"
#include "terrain/tile_source.hpp"

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

/// One tile's texels with their border, and their halvings down to 1 x 1 (mip_chain).
/// Immutable: shared between the store and its users.
struct TilePixels {
  std::vector<Image> levels;           ///< kGrey8: 1 channel; kRgb8: RGB and validity as alpha
  std::vector<Image16> linear_levels;  ///< kGreyLinear, kRgbLinear likewise; 65535 = 1.0
  /// Validity, with an eighth of the tile's texels per side; empty if all are valid.
  Image valid;

  [[nodiscard]] std::size_t bytes() const;
  /// True if there is imagery. @param u, v  in the tile with its border, in [0, 1]
  [[nodiscard]] bool has_imagery(double u, double v) const;
};

/// A tile in a format, with its mip levels.
[[nodiscard]] TilePixels tile_pixels_from(const terrain::Tile& tile, PixelFormat format);

}  // namespace overfly::renderer
