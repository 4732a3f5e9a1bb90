// Selects the graphics device to draw with.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly::renderer {

/// The parsed value of RendererOptions::device.
struct DeviceRequest {
  std::optional<int> index;
  std::string pci_address;  ///< lower case with its domain, as "0000:01:00.0"; empty if not given
  bool software = false;

  [[nodiscard]] bool any() const { return !index && pci_address.empty() && !software; }
  /// Errors: kInvalidArgument naming the text if it has none of the forms.
  static Result<DeviceRequest> parse(const std::string& text);
};

/// A device as listed, before it is used.
struct OfferedDevice {
  int index = -1;  ///< -1 = the platform without a device; its renderer is not known
  std::string pci_address;
  bool software = false;
};

/// The devices to try, best first, as indices into `offered`. The requested device is followed by
/// those that render in software.
[[nodiscard]] std::vector<std::size_t> devices_to_try(const DeviceRequest& request,
                                                      const std::vector<OfferedDevice>& offered);

/// True if the request names this device.
[[nodiscard]] bool asks_for(const DeviceRequest& request, const OfferedDevice& device);

}  // namespace overfly::renderer
