#include "renderer/egl/egl_context.hpp"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <utility>
#include <vector>

#include "renderer/device_choice.hpp"
#include "renderer/egl/egl_device.hpp"

namespace overfly::renderer::egl {

namespace {

constexpr const char* kPackages =
    "software rendering needs the packages libegl1, libegl-mesa0 and libgl1-mesa-dri";

Result<EGLContext> create_context(EGLDisplay display, const EglDevice& device) {
  EGLConfig config = EGL_NO_CONFIG_KHR;
  if (!has_extension(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_no_config_context")) {
    const std::array<EGLint, 5> wanted{
        EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLint count = 0;
    if (eglChooseConfig(display, wanted.data(), &config, 1, &count) != EGL_TRUE || count == 0) {
      return Error{ErrorCode::kUnsupported,
                   device.name() + ": no EGL configuration for OpenGL (" +
                       egl_error_text(eglGetError()) + ")"};
    }
  }
  std::string said = device.name();
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
    said += ": OpenGL " + std::to_string(major) + "." + std::to_string(minor) + " core refused (" +
            egl_error_text(eglGetError()) + ")";
  }
  return Error{ErrorCode::kUnsupported, said};
}

std::string gl_string(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text == nullptr ? "unknown" : text;
}

/// The RendererInfo note about a requested device.
std::string note_of(const std::string& asked,
                    bool granted,
                    const EglDevice& device,
                    const std::string& said) {
  const std::string drawn = device.name() + " draws";
  if (asked.empty()) return said.empty() ? std::string() : drawn + ": " + said;
  if (granted) return "device \"" + asked + "\" was requested: " + drawn;
  return "device \"" + asked + "\" was requested and does not work: " +
         (said.empty() ? std::string("EGL lists no such device") : said) + "; " + drawn +
         " instead";
}

}  // namespace

Result<std::unique_ptr<EglContext>> EglContext::open(const EglDevice& device) {
  const Result<void*> display = open_display(device);
  if (!display.ok()) return display.error();
  eglBindAPI(EGL_OPENGL_API);
  const Result<EGLContext> context = create_context(*display, device);
  if (!context.ok()) return context.error();
  std::unique_ptr<EglContext> result(new EglContext(*display, *context));
  if (Status status = result->make_current(); !status) {
    return Error{ErrorCode::kUnsupported, device.name() + ": " + status.error().message};
  }
  if (epoxy_gl_version() < 45 && !epoxy_has_gl_extension("GL_ARB_clip_control")) {
    return Error{ErrorCode::kUnsupported,
                 device.name() + ": OpenGL " + gl_string(GL_VERSION) + " of " +
                     gl_string(GL_RENDERER) + " lacks GL_ARB_clip_control"};
  }
  return result;
}

Result<std::unique_ptr<EglContext>> EglContext::create(const std::string& wanted) {
  const Result<DeviceRequest> request = DeviceRequest::parse(wanted);
  if (!request.ok()) return request.error();
  const Result<std::vector<EglDevice>> devices = egl_devices();
  if (!devices.ok()) {
    return Error{ErrorCode::kUnsupported, "EGL: " + devices.error().message + "; " + kPackages};
  }
  std::string said;
  for (const std::size_t place : devices_to_try(*request, {devices->begin(), devices->end()})) {
    const EglDevice& device = (*devices)[place];
    Result<std::unique_ptr<EglContext>> context = open(device);
    if (!context.ok()) {
      said += (said.empty() ? "" : "; ") + context.error().message;
      continue;
    }
    const bool software = (*context)->info().software;
    // A platform without a device may draw with another GPU than the requested one.
    if (!request->any() && !asks_for(*request, device) && !software) continue;
    const bool granted = asks_for(*request, device) || (request->software && software);
    (*context)->note_ = note_of(wanted, granted, device, said);
    return context;
  }
  return Error{ErrorCode::kUnsupported,
               "EGL provides no OpenGL context: " + said + "; " + kPackages};
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
    return Error{ErrorCode::kInternal,
                 "eglMakeCurrent failed (" + egl_error_text(eglGetError()) + ")"};
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
  info.device_note = note_;
  return info;
}

std::vector<GraphicsDevice> list_devices() {
  std::vector<GraphicsDevice> list;
  const Result<std::vector<EglDevice>> devices = egl_devices();
  if (!devices.ok()) return list;
  for (const EglDevice& device : *devices) {
    if (device.index < 0) continue;
    GraphicsDevice entry{device.index, device.pci_address, {}, {}};
    const Result<std::unique_ptr<EglContext>> context = EglContext::open(device);
    if (context.ok()) {
      entry.info = (*context)->info();
    } else {
      entry.fault = context.error().message;
    }
    list.push_back(entry);
  }
  return list;
}

}  // namespace overfly::renderer::egl
