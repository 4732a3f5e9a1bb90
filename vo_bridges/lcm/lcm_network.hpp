// Which LCM network a URL leads to.
#pragma once

#include <string>

namespace overfly {

/// LCM's own network (lcm_create's documentation).
inline constexpr const char* kLcmAddress = "239.255.76.67";
inline constexpr int kLcmPort = 7667;

/// "udpm://239.255.76.67:7667" of "udpm://?ttl=0": URLs of one network meet, whatever their
/// options.
/// @param url  as parse_lcm_url takes it
[[nodiscard]] inline std::string lcm_network_of(const std::string& url) {
  const std::string scheme = "udpm://";
  std::string network = url.substr(0, url.find('?'));
  if (!network.starts_with(scheme)) return network;
  const std::size_t colon = network.find(':', scheme.size());
  std::string address = network.substr(scheme.size(), colon - scheme.size());
  std::string port = colon == std::string::npos ? "" : network.substr(colon + 1);
  if (colon == std::string::npos) address = network.substr(scheme.size());
  if (address.empty()) address = kLcmAddress;
  if (port.empty()) port = std::to_string(kLcmPort);
  return scheme + address + ":" + port;
}

}  // namespace overfly
