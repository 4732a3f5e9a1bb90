// An off-screen image for drawing and reading back.
#pragma once

#include <cstddef>

#include "core/camera/image.hpp"
#include "core/result.hpp"
#include "renderer/egl/gl_objects.hpp"

namespace overfly::renderer::egl {

enum class TargetFormat { kGrey8, kRgba8, kGreyFloat, kRgbaFloat, kDepthM };

/// Removes the alpha channel of `pixels` pixels.
template <typename T>
void rgb_from_rgba(const T* rgba, T* rgb, std::size_t pixels) {
  for (std::size_t i = 0; i < pixels; ++i) {
    rgb[3 * i] = rgba[4 * i];
    rgb[3 * i + 1] = rgba[4 * i + 1];
    rgb[3 * i + 2] = rgba[4 * i + 2];
  }
}

/// A colour buffer with a depth buffer. Image row 0 is the window's row 0: y must point down in the
/// drawing, and rows are read in image order.
class RenderTarget {
 public:
  /// @param samples  0 or 1: no multisampling; more: resolved when read
  /// Errors: kUnsupported if the driver refuses such a buffer.
  static Result<RenderTarget> create(int width_px, int height_px, TargetFormat format, int samples);

  /// Binds the target and sets the viewport.
  void bind() const;
  [[nodiscard]] bool fits(int width_px, int height_px) const {
    return width_px == width_px_ && height_px == height_px_;
  }

  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }
  [[nodiscard]] TargetFormat format() const { return format_; }

  /// Starts to copy an 8-bit target into the bound pixel buffer, as red or RGBA.
  void read_to_buffer() const;
  /// Reads the drawn image: grey from kGrey8, RGB from kRgba8.
  void read(Image& image) const;
  /// Reads a float target: one channel from kDepthM and kGreyFloat, RGB from kRgbaFloat.
  void read(ImageBuffer<float>& values) const;

 private:
  RenderTarget() = default;
  void bind_for_reading() const;

  int width_px_ = 0;
  int height_px_ = 0;
  TargetFormat format_ = TargetFormat::kGrey8;
  bool multisampled_ = false;
  GlFramebuffer framebuffer_, resolved_;
  GlRenderbuffer colour_, depth_, resolved_colour_;
};

}  // namespace overfly::renderer::egl
