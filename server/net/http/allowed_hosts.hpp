// Under which names a server may be asked for, and which web pages may ask it.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace overfly::net {

/// Where a URL points to. The host is in lower case, an IPv6 address without its brackets.
struct Authority {
  std::string host;
  std::uint16_t port = 0;
  bool operator==(const Authority&) const = default;
};

/// Reads "host", "host:port" or "[address]:port". Empty for anything else.
[[nodiscard]] std::optional<Authority> parse_authority(std::string_view text,
                                                       std::uint16_t port_if_absent);

/// localhost, *.localhost, 127.0.0.0/8 and ::1.
[[nodiscard]] bool is_loopback_host(const std::string& host);

/// A page whose name is made to resolve to this machine (DNS rebinding) is of the same origin as
/// this server in its browser's eyes: only the Host header, which has that name, tells it apart.
class AllowedHosts {
 public:
  /// @param names  names and addresses besides those that are always allowed: loopback names, the
  ///   machine's host name, and the address at which a connection arrived
  explicit AllowedHosts(const std::vector<std::string>& names);

  /// Errors: kInvalidArgument for what is no host name or address by itself.
  [[nodiscard]] static Status check_name(const std::string& name);

  /// @param host           of a Host header or an Origin
  /// @param local_address  of the connection's end on this machine. As a host it needs no name to
  ///   resolve, so nobody can have made it resolve here
  [[nodiscard]] bool allows(const std::string& host, const std::string& local_address) const;

  /// True for a request without an Origin (no browser), from a page of the address that it asks
  /// for, or from a page under another of this server's names at the same port.
  /// @param host_header  which the server allows
  [[nodiscard]] bool allows_origin(const std::string& origin,
                                   const std::string& host_header,
                                   const std::string& local_address) const;

 private:
  std::set<std::string> names_;
};

}  // namespace overfly::net
