// Uploads images as textures.
#pragma once

#include <vector>

#include "core/camera/image.hpp"
#include "renderer/egl/gl_objects.hpp"
#include "renderer/tiles/tile_store.hpp"

namespace overfly::renderer::egl {

/// A texture of an image (grey or RGBA) and its mip levels, trilinear, clamped at the edges.
[[nodiscard]] GlTexture upload_texture(const std::vector<Image>& levels);
/// As above for a tile, with 8 or 16 bits.
[[nodiscard]] GlTexture upload_texture(const TilePixels& pixels);

}  // namespace overfly::renderer::egl
