// An OpenGL context without a window, on the surfaceless platform or an EGL device.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "renderer/renderer.hpp"

namespace overfly::renderer::egl {

struct EglDevice;

/// One context. The contexts of one device share its EGL display, which the process keeps open. A
/// context belongs to the thread that creates it.
class EglContext {
 public:
  /// Creates a context and makes it current: OpenGL 4.5 core, or 3.3 core with ARB_clip_control.
  /// Devices that do not work are skipped and listed in info().
  /// @param wanted  as RendererOptions::device
  /// Errors: kInvalidArgument if `wanted` has none of its forms; kUnsupported with EGL's error and
  /// the missing package.
  static Result<std::unique_ptr<EglContext>> create(const std::string& wanted = "");
  /// The same on a given device. Errors: kUnsupported with EGL's error.
  static Result<std::unique_ptr<EglContext>> open(const EglDevice& device);
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  /// Makes the context current on this thread. Errors: kInternal if EGL fails.
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
