// Addresses of MAVLink links as text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace overfly::flight::mavlink {

enum class LinkKind {
  kUdpListen,  ///< waits for datagrams: "udp-listen:HOST:PORT"
  kUdp,        ///< sends to a host: "udp:HOST:PORT"
  kTcpListen,  ///< waits for a connection: "tcp-listen:HOST:PORT"
  kTcp,        ///< connects: "tcp:HOST:PORT"
  kSerial,     ///< "serial:DEVICE:BAUD"
};

struct LinkAddress {
  LinkKind kind = LinkKind::kUdpListen;
  std::string host;  ///< numeric, IPv4 or IPv6 without brackets
  std::uint16_t port = 0;
  std::string device;           ///< an absolute path
  std::uint32_t baud_rate = 0;  ///< [1/s]

  /// The text that parses to this address.
  [[nodiscard]] std::string text() const;
};

/// Reads an address. HOST is a numeric address, IPv6 in brackets, or "localhost", which stands for
/// 127.0.0.1; other names are rejected, because nothing in the program asks a name server. PORT is
/// in [1, 65535]; for the kinds that listen 0 stands for any free port.
/// @param field  names the address in messages
/// Errors: kInvalidArgument naming field, value and limit.
[[nodiscard]] Result<LinkAddress> parse_link_address(std::string_view text,
                                                     const std::string& field);

}  // namespace overfly::flight::mavlink
