#include "renderer/egl/pixel_ring.hpp"

#include <cstdint>
#include <cstring>

namespace overfly::renderer::egl {

PixelRing::~PixelRing() {
  for (const Slot& slot : slots_) {
    if (slot.copied != nullptr) glDeleteSync(slot.copied);
  }
}

void PixelRing::push(const RenderTarget& target) {
  Slot& slot = slots_[(oldest_ + used_) % slots_.size()];
  ++used_;
  slot.width_px = target.width_px();
  slot.height_px = target.height_px();
  slot.grey = target.format() == TargetFormat::kGrey8;
  const std::size_t bytes =
      static_cast<std::size_t>(slot.width_px) * slot.height_px * (slot.grey ? 1 : 4);
  if (slot.buffer.name() == 0) slot.buffer = GlBuffer::make();
  glBindBuffer(GL_PIXEL_PACK_BUFFER, slot.buffer.name());
  if (slot.bytes != bytes) {
    glBufferData(GL_PIXEL_PACK_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_STREAM_READ);
    slot.bytes = bytes;
  }
  target.read_to_buffer();
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  slot.copied = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  glFlush();
}

Status PixelRing::pop(Image& image) {
  Slot& slot = slots_[oldest_];
  oldest_ = (oldest_ + 1) % slots_.size();
  --used_;
  constexpr GLuint64 kLongestNs = 10'000'000'000;
  const GLenum waited = glClientWaitSync(slot.copied, GL_SYNC_FLUSH_COMMANDS_BIT, kLongestNs);
  glDeleteSync(slot.copied);
  slot.copied = nullptr;
  if (waited == GL_WAIT_FAILED || waited == GL_TIMEOUT_EXPIRED) {
    return Error{ErrorCode::kInternal, "OpenGL did not finish an image within 10 s"};
  }
  glBindBuffer(GL_PIXEL_PACK_BUFFER, slot.buffer.name());
  const auto* pixels = static_cast<const std::uint8_t*>(glMapBufferRange(
      GL_PIXEL_PACK_BUFFER, 0, static_cast<GLsizeiptr>(slot.bytes), GL_MAP_READ_BIT));
  if (pixels == nullptr) {
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    return Error{ErrorCode::kInternal, "OpenGL failed to map a pixel buffer"};
  }
  const int channels = slot.grey ? 1 : 3;
  if (image.width_px != slot.width_px || image.height_px != slot.height_px ||
      image.channels != channels) {
    image = Image(slot.width_px, slot.height_px, channels);
  }
  if (slot.grey) {
    std::memcpy(image.data.data(), pixels, slot.bytes);
  } else {
    rgb_from_rgba(pixels, image.data.data(), slot.bytes / 4);
  }
  glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  return {};
}

}  // namespace overfly::renderer::egl
