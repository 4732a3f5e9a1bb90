// Which of a machine's graphics devices to draw with.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly::renderer {

/// What RendererOptions::device asks for.
struct DeviceWish {
  std::optional<int> index;
  std::string pci_address;  ///< lower case with its domain, as "0000:01:00.0"; empty = none named
  bool software = false;

  [[nodiscard]] bool any() const { return !index && pci_address.empty() && !software; }
  /// Errors: kInvalidArgument naming the text, when it is none of the forms.
  static Result<DeviceWish> parse(const std::string& text);
};

/// A device as it is offered, before anything is drawn with it.
struct OfferedDevice {
  int index = -1;  ///< -1 = the platform without a device, whatever that draws with
  std::string pci_address;
  bool software = false;
};

/// The devices to try, the best first, as places in `offered`. After the device that was asked for
/// come those that draw in software.
[[nodiscard]] std::vector<std::size_t> devices_to_try(const DeviceWish& wish,
                                                      const std::vector<OfferedDevice>& offered);

/// True where the wish names this device.
[[nodiscard]] bool asks_for(const DeviceWish& wish, const OfferedDevice& device);

}  // namespace overfly::renderer
