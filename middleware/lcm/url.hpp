// Parses URLs of LCM networks and sets the receive buffer size for images.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "core/result.hpp"

namespace overfly::lcm {

/// Minimum receive buffer to request. An image of 1280 x 960 is 1.2 MB in 830 packets, most of
/// which are lost with the usual 208 KiB.
inline constexpr std::int64_t kSmallestReceiveBufferBytes = std::int64_t{2} << 20U;

/// "PROVIDER://NETWORK?NAME=VALUE&..."
struct Url {
  std::string provider;  ///< "udpm", "memq" or "file"
  std::string network;   ///< "ADDRESS:PORT", "", or the path of a log
  std::map<std::string, std::string> options;

  [[nodiscard]] std::string text() const;
  /// For udpm: the multicast address, by default LCM's.
  [[nodiscard]] std::string address() const;
  [[nodiscard]] int port() const;
};

/// Errors: kInvalidArgument naming the part of the URL, its value and limit.
[[nodiscard]] Result<Url> parse_url(const std::string& text);

/// Adds recv_buf_size to the URL if it is missing (udpm only).
[[nodiscard]] Url with_receive_buffer(Url url);

/// Largest receive buffer that the kernel allows (net.core.rmem_max); 0 = unknown.
[[nodiscard]] std::int64_t largest_receive_buffer_bytes();

}  // namespace overfly::lcm
