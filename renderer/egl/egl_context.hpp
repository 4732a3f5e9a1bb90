// An OpenGL context without a window, on the surfaceless platform or an EGL device.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "renderer/renderer.hpp"

namespace overfly::renderer::egl {

struct EglDevice;

/// One context; those of one device share its EGL display, which the process keeps open.
/// A context belongs to the thread that makes it.
class EglContext {
 public:
  /// Makes a context and leaves it current. OpenGL 4.5 core, or 3.3 core with
  /// ARB_clip_control. What does not work is passed over, and info() says so.
  /// @param wanted  as RendererOptions::device
  /// Errors: kInvalidArgument when `wanted` is none of its forms; kUnsupported with what EGL said
  /// and which package is missing.
  static Result<std::unique_ptr<EglContext>> create(const std::string& wanted = "");
  /// The same on one device. Errors: kUnsupported with what EGL said.
  static Result<std::unique_ptr<EglContext>> open(const EglDevice& device);
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  /// Makes the context current on this thread. Errors: kInternal if EGL refuses.
  Status make_current();
  [[nodiscard]] RendererInfo info() const;

 private:
  EglContext(void* display, void* context) : display_(display), context_(context) {}

  void* display_;  // EGLDisplay
  void* context_;  // EGLContext
  std::string note_;
};

/// As list_graphics_devices().
[[nodiscard]] std::vector<GraphicsDevice> list_devices();

}  // namespace overfly::renderer::egl
