// Images being copied from the GPU, several at a time.
#pragma once

#include <cstddef>
#include <vector>

#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "renderer/egl/gl_objects.hpp"
#include "renderer/egl/render_target.hpp"

namespace overfly::renderer::egl {

/// A ring of pixel buffers. OpenGL copies into them while the next image is drawn; only taking the
/// oldest image waits for its copy.
class PixelRing {
 public:
  explicit PixelRing(std::size_t images) : slots_(images) {}
  ~PixelRing();
  PixelRing(const PixelRing&) = delete;
  PixelRing& operator=(const PixelRing&) = delete;

  [[nodiscard]] bool full() const { return used_ == slots_.size(); }
  [[nodiscard]] bool empty() const { return used_ == 0; }
  /// Starts to copy the drawn image. @pre not full; an 8-bit target without multisampling
  void push(const RenderTarget& target);
  /// Waits for the oldest copy and takes it. @pre not empty
  /// Errors: kInternal if OpenGL cannot map the buffer.
  Status pop(Image& image);

 private:
  struct Slot {
    GlBuffer buffer;
    std::size_t bytes = 0;
    int width_px = 0, height_px = 0;
    bool grey = true;
    GLsync copied = nullptr;
  };
  std::vector<Slot> slots_;
  std::size_t oldest_ = 0;
  std::size_t used_ = 0;
};

}  // namespace overfly::renderer::egl
