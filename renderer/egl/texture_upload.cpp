#include "renderer/egl/texture_upload.hpp"

#include <cstdint>

namespace overfly::renderer::egl {

namespace {

template <typename T>
GlTexture upload(const std::vector<ImageBuffer<T>>& levels) {
  constexpr bool kDeep = sizeof(T) == sizeof(std::uint16_t);
  constexpr GLint kGrey = kDeep ? GL_R16 : GL_R8;
  constexpr GLint kColour = kDeep ? GL_RGBA16 : GL_RGBA8;
  GlTexture texture = GlTexture::make();
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  const bool grey = levels.front().channels == 1;
  const GLint internal = grey ? kGrey : kColour;
  const GLenum format = grey ? GL_RED : GL_RGBA;
  const GLenum type = kDeep ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE;
  const auto count = static_cast<GLint>(levels.size());
  // Immutable storage if available: a GPU's driver then neither moves nor validates the texture
  // later.
  const bool at_once = epoxy_gl_version() >= 42 || epoxy_has_gl_extension("GL_ARB_texture_storage");
  if (at_once) {
    glTexStorage2D(GL_TEXTURE_2D,
                   count,
                   static_cast<GLenum>(internal),
                   levels.front().width_px,
                   levels.front().height_px);
  }
  for (GLint i = 0; i < count; ++i) {
    const ImageBuffer<T>& level = levels[static_cast<std::size_t>(i)];
    if (at_once) {
      glTexSubImage2D(
          GL_TEXTURE_2D, i, 0, 0, level.width_px, level.height_px, format, type, level.data.data());
      continue;
    }
    glTexImage2D(GL_TEXTURE_2D,
                 i,
                 internal,
                 level.width_px,
                 level.height_px,
                 0,
                 format,
                 type,
                 level.data.data());
  }
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, count - 1);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

}  // namespace

GlTexture upload_texture(const std::vector<Image>& levels) { return upload(levels); }

GlTexture upload_texture(const TilePixels& pixels) {
  return pixels.levels.empty() ? upload(pixels.linear_levels) : upload(pixels.levels);
}

}  // namespace overfly::renderer::egl
