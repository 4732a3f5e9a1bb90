// What EGL offers to draw with.
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

/// True where a list of names parted by spaces holds the name.
[[nodiscard]] bool has_extension(const char* list, const char* name);
/// An EGL error as EGL's documents write it, as in "0x3001".
[[nodiscard]] std::string egl_error_text(int error);

/// All of them: devices in EGL's order, then the surfaceless platform.
/// Errors: kUnsupported when there is no EGL, or it offers nothing.
[[nodiscard]] Result<std::vector<EglDevice>> egl_devices();

/// The device's display, initialised; the process keeps it. Errors: kUnsupported with what EGL
/// said.
[[nodiscard]] Result<void*> open_display(const EglDevice& device);

}  // namespace overfly::renderer::egl
