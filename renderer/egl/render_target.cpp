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
    case TargetFormat::kGreyFloat:
    case TargetFormat::kDepthM:
      return GL_R32F;
    case TargetFormat::kRgbaFloat:
      return GL_RGBA32F;
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

namespace {

/// Reading RGB directly is slow in software drivers.
template <typename T>
ImageBuffer<T> read_rgb(int width_px, int height_px, GLenum type) {
  std::vector<T> rgba(static_cast<std::size_t>(width_px) * height_px * 4);
  glReadPixels(0, 0, width_px, height_px, GL_RGBA, type, rgba.data());
  ImageBuffer<T> image(width_px, height_px, 3);
  rgb_from_rgba(rgba.data(), image.data.data(), rgba.size() / 4);
  return image;
}

}  // namespace

void RenderTarget::read_to_buffer() const {
  bind_for_reading();
  const GLenum format = format_ == TargetFormat::kGrey8 ? GL_RED : GL_RGBA;
  glReadPixels(0, 0, width_px_, height_px_, format, GL_UNSIGNED_BYTE, nullptr);
}

void RenderTarget::read(Image& image) const {
  bind_for_reading();
  if (format_ != TargetFormat::kGrey8) {
    image = read_rgb<std::uint8_t>(width_px_, height_px_, GL_UNSIGNED_BYTE);
    return;
  }
  if (image.width_px != width_px_ || image.height_px != height_px_ || image.channels != 1) {
    image = Image(width_px_, height_px_, 1);
  }
  glReadPixels(0, 0, width_px_, height_px_, GL_RED, GL_UNSIGNED_BYTE, image.data.data());
}

void RenderTarget::read(ImageBuffer<float>& values) const {
  bind_for_reading();
  if (format_ == TargetFormat::kRgbaFloat) {
    values = read_rgb<float>(width_px_, height_px_, GL_FLOAT);
    return;
  }
  values = ImageBuffer<float>(width_px_, height_px_, 1);
  glReadPixels(0, 0, width_px_, height_px_, GL_RED, GL_FLOAT, values.data.data());
}

}  // namespace overfly::renderer::egl
