// Identifies the LCM network of a URL.
#pragma once

#include <string>

namespace overfly::lcm {

/// LCM's default network (documentation of lcm_create).
inline constexpr const char* kAddress = "239.255.76.67";
inline constexpr int kPort = 7667;

/// Reduces a URL to its network: "udpm://?ttl=0" gives "udpm://239.255.76.67:7667". URLs with the
/// same result share a network, whatever their options.
/// @param url  a URL accepted by parse_url
[[nodiscard]] inline std::string network_of(const std::string& url) {
  const std::string scheme = "udpm://";
  std::string network = url.substr(0, url.find('?'));
  if (!network.starts_with(scheme)) return network;
  const std::size_t colon = network.find(':', scheme.size());
  std::string address = network.substr(scheme.size(), colon - scheme.size());
  std::string port = colon == std::string::npos ? "" : network.substr(colon + 1);
  if (colon == std::string::npos) address = network.substr(scheme.size());
  if (address.empty()) address = kAddress;
  if (port.empty()) port = std::to_string(kPort);
  return scheme + address + ":" + port;
}

}  // namespace overfly::lcm
