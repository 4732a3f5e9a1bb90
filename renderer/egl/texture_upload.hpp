// Images to textures.
#pragma once

#include <vector>

#include "core/image.hpp"
#include "renderer/egl/gl_objects.hpp"

namespace overfly::renderer::egl {

/// A texture of an image (grey or RGBA) and its mip levels, trilinear, clamped at the edges.
[[nodiscard]] GlTexture upload_texture(const std::vector<Image>& levels);

}  // namespace overfly::renderer::egl
