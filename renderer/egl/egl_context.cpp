#include "renderer/egl/egl_context.hpp"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <vector>

namespace overfly::renderer::egl {

namespace {

constexpr const char* kPackages =
    "software rendering needs the packages libegl1, libegl-mesa0 and libgl1-mesa-dri";

std::string hex(EGLint error) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "0x%04X", static_cast<unsigned>(error));
  return text.data();
}

bool has_extension(const char* list, const char* name) {
  const std::size_t length = std::strlen(name);
  for (const char* at = list; at != nullptr && (at = std::strstr(at, name)) != nullptr;
       at += length) {
    const bool starts = at == list || at[-1] == ' ';
    if (starts && (at[length] == ' ' || at[length] == '\0')) return true;
  }
  return false;
}

/// Initialises a display; what went wrong is added to `said`.
bool initialise(EGLDisplay display, const std::string& name, std::string& said) {
  if (display == EGL_NO_DISPLAY) {
    said += name + ": no display (" + hex(eglGetError()) + "); ";
    return false;
  }
  if (eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
    said += name + ": eglInitialize failed (" + hex(eglGetError()) + "); ";
    return false;
  }
  const char* apis = eglQueryString(display, EGL_CLIENT_APIS);
  if (apis == nullptr || std::strstr(apis, "OpenGL") == nullptr) {
    said += name + ": no desktop OpenGL; ";
    return false;
  }
  return true;
}

EGLDisplay open_display(std::string& said) {
  // Epoxy ends the process when the library is not there, so look first.
  if (dlopen("libEGL.so.1", RTLD_LAZY | RTLD_GLOBAL) == nullptr) {
    said += "libEGL.so.1 is not installed; ";
    return EGL_NO_DISPLAY;
  }
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (!has_extension(extensions, "EGL_EXT_platform_base")) {
    said += "libEGL offers no platforms (no EGL vendor is installed); ";
    return EGL_NO_DISPLAY;
  }
  if (has_extension(extensions, "EGL_MESA_platform_surfaceless")) {
    EGLDisplay display =
        eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (initialise(display, "surfaceless platform", said)) return display;
  } else {
    said += "no EGL_MESA_platform_surfaceless; ";
  }
  if (!has_extension(extensions, "EGL_EXT_platform_device")) {
    said += "no EGL_EXT_platform_device; ";
    return EGL_NO_DISPLAY;
  }
  std::array<EGLDeviceEXT, 16> devices{};
  EGLint count = 0;
  if (eglQueryDevicesEXT(devices.size(), devices.data(), &count) != EGL_TRUE || count == 0) {
    said += "no EGL devices (" + hex(eglGetError()) + "); ";
    return EGL_NO_DISPLAY;
  }
  for (EGLint i = 0; i < count; ++i) {
    EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
    if (initialise(display, "EGL device " + std::to_string(i), said)) return display;
  }
  return EGL_NO_DISPLAY;
}

/// The process's display, opened by the first caller that succeeds and never closed.
Result<EGLDisplay> shared_display() {
  static std::mutex mutex;
  static EGLDisplay display = EGL_NO_DISPLAY;
  const std::lock_guard lock(mutex);
  if (display != EGL_NO_DISPLAY) return display;
  std::string said;
  display = open_display(said);
  if (display == EGL_NO_DISPLAY) {
    return Error{ErrorCode::kUnsupported, "EGL has no display: " + said + kPackages};
  }
  return display;
}

EGLContext create_context(EGLDisplay display, std::string& said) {
  EGLConfig config = EGL_NO_CONFIG_KHR;
  if (!has_extension(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_no_config_context")) {
    const std::array<EGLint, 5> wanted{
        EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLint count = 0;
    if (eglChooseConfig(display, wanted.data(), &config, 1, &count) != EGL_TRUE || count == 0) {
      said += "no EGL configuration for OpenGL (" + hex(eglGetError()) + "); ";
      return EGL_NO_CONTEXT;
    }
  }
  for (const auto& [major, minor] : {std::pair{4, 5}, std::pair{3, 3}}) {
    const std::array<EGLint, 7> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                           major,
                                           EGL_CONTEXT_MINOR_VERSION,
                                           minor,
                                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                           EGL_NONE};
    EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
    if (context != EGL_NO_CONTEXT) return context;
    said += "OpenGL " + std::to_string(major) + "." + std::to_string(minor) + " core refused (" +
            hex(eglGetError()) + "); ";
  }
  return EGL_NO_CONTEXT;
}

std::string gl_string(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text == nullptr ? "unknown" : text;
}

}  // namespace

Result<std::unique_ptr<EglContext>> EglContext::create(const std::string& /*device*/) {
  const Result<EGLDisplay> display = shared_display();
  if (!display.ok()) return display.error();
  eglBindAPI(EGL_OPENGL_API);
  std::string said;
  EGLContext context = create_context(*display, said);
  if (context == EGL_NO_CONTEXT) {
    return Error{ErrorCode::kUnsupported, "EGL gives no OpenGL context: " + said + kPackages};
  }
  std::unique_ptr<EglContext> result(new EglContext(*display, context));
  if (Status status = result->make_current(); !status) {
    return Error{ErrorCode::kUnsupported, status.error().message + "; " + kPackages};
  }
  if (epoxy_gl_version() < 45 && !epoxy_has_gl_extension("GL_ARB_clip_control")) {
    return Error{ErrorCode::kUnsupported,
                 "OpenGL " + gl_string(GL_VERSION) + " of " + gl_string(GL_RENDERER) +
                     " lacks GL_ARB_clip_control"};
  }
  return result;
}

EglContext::~EglContext() {
  if (eglGetCurrentContext() == context_) {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  eglDestroyContext(display_, context_);
}

Status EglContext::make_current() {
  eglBindAPI(EGL_OPENGL_API);
  if (eglGetCurrentContext() == context_) return {};
  if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
    return Error{ErrorCode::kInternal, "eglMakeCurrent failed (" + hex(eglGetError()) + ")"};
  }
  return {};
}

RendererInfo EglContext::info() const {
  RendererInfo info;
  info.backend = "egl";
  info.device = gl_string(GL_RENDERER);
  info.gl_version = gl_string(GL_VERSION);
  info.software = info.device.find("llvmpipe") != std::string::npos ||
                  info.device.find("softpipe") != std::string::npos ||
                  info.device.find("SwiftShader") != std::string::npos;
  return info;
}

}  // namespace overfly::renderer::egl
