// URLs of LCM networks: which ones the door takes, and the receive buffer that images need.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "core/result.hpp"

namespace overfly {

/// What to ask the kernel for at least: an image of 1280 x 960 is 1.2 MB in 830 packets, and of
/// those the customary 208 KiB lose most.
inline constexpr std::int64_t kSmallestReceiveBufferBytes = std::int64_t{2} << 20U;

/// "PROVIDER://NETWORK?NAME=VALUE&..."
struct LcmUrl {
  std::string provider;  ///< "udpm", "memq" or "file"
  std::string network;   ///< "ADDRESS:PORT", "", or the path of a log
  std::map<std::string, std::string> options;

  [[nodiscard]] std::string text() const;
  /// Of udpm: the multicast address, LCM's own where the URL names none.
  [[nodiscard]] std::string address() const;
  [[nodiscard]] int port() const;
};

/// Errors: kInvalidArgument naming the part of the URL, its value and what it must be.
[[nodiscard]] Result<LcmUrl> parse_lcm_url(const std::string& text);

/// The URL with recv_buf_size where it is missing (udpm alone).
[[nodiscard]] LcmUrl with_receive_buffer(LcmUrl url);

/// What the kernel lets a socket's receive buffer be (net.core.rmem_max); 0 = not known.
[[nodiscard]] std::int64_t largest_receive_buffer_bytes();

}  // namespace overfly
