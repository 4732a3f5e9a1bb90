#include "renderer/device_choice.hpp"

#include <algorithm>

#include "core/text/pattern.hpp"

namespace overfly::renderer {

Result<DeviceRequest> DeviceRequest::parse(const std::string& text) {
  constexpr const char* kPciAddress = "([0-9a-fA-F]{4,8}:)?[0-9a-fA-F]{2}:[0-9a-fA-F]{2}\\.[0-7]";
  DeviceRequest request;
  if (text == "software") {
    request.software = true;
  } else if (matches_pattern(text, "[0-9]{1,3}")) {
    request.index = std::stoi(text);
  } else if (matches_pattern(text, kPciAddress)) {
    request.pci_address = text;
    std::transform(text.begin(), text.end(), request.pci_address.begin(), [](char c) {
      return c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    if (std::count(text.begin(), text.end(), ':') == 1) request.pci_address.insert(0, "0000:");
    // The domain as the kernel writes it: nvidia-smi writes eight digits.
    while (request.pci_address.find(':') > 4 && request.pci_address.front() == '0') {
      request.pci_address.erase(0, 1);
    }
  } else if (!text.empty()) {
    return Error{ErrorCode::kInvalidArgument,
                 "device \"" + text +
                     "\": must be empty, an index, a PCI address such as 0000:01:00.0, or "
                     "\"software\""};
  }
  return request;
}

bool asks_for(const DeviceRequest& request, const OfferedDevice& device) {
  if (request.index) return device.index == *request.index;
  if (!request.pci_address.empty()) return device.pci_address == request.pci_address;
  return request.software ? device.software : true;
}

std::vector<std::size_t> devices_to_try(const DeviceRequest& request,
                                        const std::vector<OfferedDevice>& offered) {
  std::vector<std::size_t> order;
  const auto add = [&](const auto& suits) {
    for (std::size_t i = 0; i < offered.size(); ++i) {
      const bool known = std::find(order.begin(), order.end(), i) != order.end();
      if (!known && suits(offered[i])) order.push_back(i);
    }
  };
  const auto platform = [](const OfferedDevice& device) { return device.index < 0; };
  const auto software = [](const OfferedDevice& device) { return device.software; };
  if (request.any()) {
    add([](const OfferedDevice& device) { return device.index >= 0 && !device.software; });
    add(platform);
    add(software);
  } else {
    if (!request.software)
      add([&](const OfferedDevice& device) { return asks_for(request, device); });
    add(software);
    add(platform);
  }
  return order;
}

}  // namespace overfly::renderer
