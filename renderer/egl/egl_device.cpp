#include "renderer/egl/egl_device.hpp"

#include <dlfcn.h>
#include <epoxy/egl.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <system_error>

namespace overfly::renderer::egl {

namespace fs = std::filesystem;

namespace {

/// EGL_DRM_RENDER_NODE_FILE_EXT, which is missing in epoxy's header.
constexpr EGLint kRenderNodeFile = 0x3377;

/// The PCI address of a device file's device, as given by the kernel.
std::string pci_address_of_node(const char* node) {
  if (node == nullptr) return {};
  std::error_code failure;
  const fs::path device =
      fs::canonical(fs::path("/sys/class/drm") / fs::path(node).filename() / "device", failure);
  if (failure) return {};
  const std::string name = device.filename().string();
  const Result<DeviceRequest> address = DeviceRequest::parse(name);
  return address.ok() ? address->pci_address : std::string();
}

/// The PCI address of a machine's only NVIDIA device, if no device file gives it.
std::string pci_address_of_only_nvidia() {
  std::error_code failure;
  std::string found;
  for (fs::directory_iterator at("/proc/driver/nvidia/gpus", failure), end; !failure && at != end;
       at.increment(failure)) {
    if (!found.empty()) return {};
    found = at->path().filename().string();
  }
  return found;
}

std::string pci_address_of(EGLDeviceEXT device, const char* extensions) {
  std::string address;
  if (has_extension(extensions, "EGL_EXT_device_drm")) {
    address = pci_address_of_node(eglQueryDeviceStringEXT(device, EGL_DRM_DEVICE_FILE_EXT));
  }
  if (address.empty() && has_extension(extensions, "EGL_EXT_device_drm_render_node")) {
    address = pci_address_of_node(eglQueryDeviceStringEXT(device, kRenderNodeFile));
  }
  if (address.empty() && has_extension(extensions, "EGL_NV_device_cuda")) {
    address = pci_address_of_only_nvidia();
  }
  return address;
}

void add_devices(std::vector<EglDevice>& devices) {
  std::array<EGLDeviceEXT, 32> handles{};
  EGLint count = 0;
  if (eglQueryDevicesEXT(handles.size(), handles.data(), &count) != EGL_TRUE) return;
  for (EGLint i = 0; i < count; ++i) {
    const char* extensions = eglQueryDeviceStringEXT(handles[i], EGL_EXTENSIONS);
    EglDevice device;
    device.index = i;
    device.handle = handles[i];
    device.software = has_extension(extensions, "EGL_MESA_device_software");
    device.pci_address = pci_address_of(handles[i], extensions);
    devices.push_back(device);
  }
}

}  // namespace

std::string EglDevice::name() const {
  if (index < 0) return "surfaceless platform";
  std::string text = "EGL device " + std::to_string(index);
  if (software) return text + " (software)";
  return pci_address.empty() ? text : text + " (" + pci_address + ")";
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

std::string egl_error_text(int error) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "0x%04X", static_cast<unsigned>(error));
  return text.data();
}

Result<std::vector<EglDevice>> egl_devices() {
  // Epoxy ends the process if the library is missing, so it is checked first.
  if (dlopen("libEGL.so.1", RTLD_LAZY | RTLD_GLOBAL) == nullptr) {
    return Error{ErrorCode::kUnsupported, "libEGL.so.1 is not installed"};
  }
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (!has_extension(extensions, "EGL_EXT_platform_base")) {
    return Error{ErrorCode::kUnsupported, "libEGL lists no platforms (no EGL vendor is installed)"};
  }
  std::vector<EglDevice> devices;
  const bool enumerates = has_extension(extensions, "EGL_EXT_device_base") ||
                          (has_extension(extensions, "EGL_EXT_device_enumeration") &&
                           has_extension(extensions, "EGL_EXT_device_query"));
  if (enumerates && has_extension(extensions, "EGL_EXT_platform_device")) add_devices(devices);
  if (has_extension(extensions, "EGL_MESA_platform_surfaceless")) devices.emplace_back();
  if (!devices.empty()) return devices;
  return Error{ErrorCode::kUnsupported,
               "libEGL has neither devices nor EGL_MESA_platform_surfaceless"};
}

Result<void*> open_display(const EglDevice& device) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  EGLDisplay display =
      device.handle != nullptr
          ? eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device.handle, nullptr)
          : eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display == EGL_NO_DISPLAY) {
    return Error{ErrorCode::kUnsupported,
                 device.name() + ": no display (" + egl_error_text(eglGetError()) + ")"};
  }
  // Does nothing for a display that is already initialised.
  if (eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
    return Error{ErrorCode::kUnsupported,
                 device.name() + ": eglInitialize failed (" + egl_error_text(eglGetError()) + ")"};
  }
  const char* apis = eglQueryString(display, EGL_CLIENT_APIS);
  if (apis == nullptr || std::strstr(apis, "OpenGL") == nullptr) {
    return Error{ErrorCode::kUnsupported, device.name() + ": no desktop OpenGL"};
  }
  return static_cast<void*>(display);
}

}  // namespace overfly::renderer::egl
