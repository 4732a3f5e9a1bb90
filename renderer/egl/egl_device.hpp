// The devices listed by EGL.
#pragma once

#include <string>
#include <vector>

#include "core/result.hpp"
#include "renderer/device_choice.hpp"

namespace overfly::renderer::egl {

/// An EGL device, or the surfaceless platform.
struct EglDevice : OfferedDevice {
  void* handle = nullptr;  ///< EGLDeviceEXT; null for the platform

  /// As in "EGL device 0 (0000:01:00.0)".
  [[nodiscard]] std::string name() const;
};

/// True if a space-separated list of names contains the name.
[[nodiscard]] bool has_extension(const char* list, const char* name);
/// An EGL error code in the notation of EGL's documentation, as "0x3001".
[[nodiscard]] std::string egl_error_text(int error);

/// All of them: devices in EGL's order, then the surfaceless platform.
/// Errors: kUnsupported if there is no EGL, or if it lists nothing.
[[nodiscard]] Result<std::vector<EglDevice>> egl_devices();

/// The device's initialised display, kept open by the process. Errors: kUnsupported with EGL's
/// error.
[[nodiscard]] Result<void*> open_display(const EglDevice& device);

}  // namespace overfly::renderer::egl
