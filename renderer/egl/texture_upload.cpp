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
  for (std::size_t i = 0; i < levels.size(); ++i) {
    glTexImage2D(GL_TEXTURE_2D,
                 static_cast<GLint>(i),
                 grey ? kGrey : kColour,
                 levels[i].width_px,
                 levels[i].height_px,
                 0,
                 grey ? GL_RED : GL_RGBA,
                 kDeep ? GL_UNSIGNED_SHORT : GL_UNSIGNED_BYTE,
                 levels[i].data.data());
  }
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, static_cast<GLint>(levels.size()) - 1);
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
