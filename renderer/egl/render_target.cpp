#include "renderer/egl/render_target.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace overfly::renderer::egl {

namespace {

GLenum internal_format(TargetFormat format) {
  switch (format) {
    case TargetFormat::kGrey8:
      return GL_R8;
    case TargetFormat::kRgba8:
      return GL_RGBA8;
    case TargetFormat::kDepthM:
      return GL_R32F;
  }
  return GL_RGBA8;
}

GlRenderbuffer make_buffer(GLenum format, int width_px, int height_px, int samples) {
  GlRenderbuffer buffer = GlRenderbuffer::make();
  glBindRenderbuffer(GL_RENDERBUFFER, buffer.name());
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, width_px, height_px);
  return buffer;
}

}  // namespace

Result<RenderTarget> RenderTarget::create(int width_px,
                                          int height_px,
                                          TargetFormat format,
                                          int samples) {
  RenderTarget target;
  target.width_px_ = width_px;
  target.height_px_ = height_px;
  target.format_ = format;
  target.multisampled_ = samples > 1;
  const int count = target.multisampled_ ? samples : 0;
  target.framebuffer_ = GlFramebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer_.name());
  target.colour_ = make_buffer(internal_format(format), width_px, height_px, count);
  glFramebufferRenderbuffer(
      GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target.colour_.name());
  target.depth_ = make_buffer(GL_DEPTH_COMPONENT32F, width_px, height_px, count);
  glFramebufferRenderbuffer(
      GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, target.depth_.name());
  GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE && target.multisampled_) {
    target.resolved_ = GlFramebuffer::make();
    glBindFramebuffer(GL_FRAMEBUFFER, target.resolved_.name());
    target.resolved_colour_ = make_buffer(internal_format(format), width_px, height_px, 0);
    glFramebufferRenderbuffer(
        GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target.resolved_colour_.name());
    status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  }
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    return Error{ErrorCode::kUnsupported,
                 "the driver has no framebuffer of " + std::to_string(width_px) + " x " +
                     std::to_string(height_px) + " px with " + std::to_string(count) +
                     " samples (status " + std::to_string(status) + ")"};
  }
  return target;
}

void RenderTarget::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, width_px_, height_px_);
}

void RenderTarget::bind_for_reading() const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.name());
  if (multisampled_) {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_.name());
    glBlitFramebuffer(
        0, 0, width_px_, height_px_, 0, 0, width_px_, height_px_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved_.name());
  }
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
}

void RenderTarget::read(Image& image) const {
  bind_for_reading();
  if (format_ == TargetFormat::kGrey8) {
    image = Image(width_px_, height_px_, 1);
    glReadPixels(0, 0, width_px_, height_px_, GL_RED, GL_UNSIGNED_BYTE, image.data.data());
    return;
  }
  // Reading RGB directly takes a slow path in software drivers.
  std::vector<std::uint8_t> rgba(static_cast<std::size_t>(width_px_) * height_px_ * 4);
  glReadPixels(0, 0, width_px_, height_px_, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  image = Image(width_px_, height_px_, 3);
  const std::size_t pixels = rgba.size() / 4;
  for (std::size_t i = 0; i < pixels; ++i) {
    image.data[3 * i] = rgba[4 * i];
    image.data[3 * i + 1] = rgba[4 * i + 1];
    image.data[3 * i + 2] = rgba[4 * i + 2];
  }
}

void RenderTarget::read(DepthImage& depth) const {
  bind_for_reading();
  depth = DepthImage(width_px_, height_px_, 1);
  glReadPixels(0, 0, width_px_, height_px_, GL_RED, GL_FLOAT, depth.data.data());
}

}  // namespace overfly::renderer::egl
