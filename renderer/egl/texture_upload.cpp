#include "renderer/egl/texture_upload.hpp"

namespace overfly::renderer::egl {

GlTexture upload_texture(const std::vector<Image>& levels) {
  GlTexture texture = GlTexture::make();
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  const bool grey = levels.front().channels == 1;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    glTexImage2D(GL_TEXTURE_2D,
                 static_cast<GLint>(i),
                 grey ? GL_R8 : GL_RGBA8,
                 levels[i].width_px,
                 levels[i].height_px,
                 0,
                 grey ? GL_RED : GL_RGBA,
                 GL_UNSIGNED_BYTE,
                 levels[i].data.data());
  }
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, static_cast<GLint>(levels.size()) - 1);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

}  // namespace overfly::renderer::egl
