// An OpenGL context without a window, on the surfaceless platform or an EGL device.
#pragma once

#include <memory>
#include <string>

#include "core/result.hpp"
#include "renderer/renderer.hpp"

namespace overfly::renderer::egl {

/// One context; all share the process's EGL display, which is opened once and stays open.
/// A context belongs to the thread that makes it.
class EglContext {
 public:
  /// Makes a context and leaves it current. OpenGL 4.5 core, or 3.3 core with
  /// ARB_clip_control. Errors: kUnsupported with what EGL said and which package is missing.
  static Result<std::unique_ptr<EglContext>> create(const std::string& device = "");
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
};

}  // namespace overfly::renderer::egl
