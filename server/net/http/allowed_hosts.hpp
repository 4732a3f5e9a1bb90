// Host names under which clients may reach a server, and web pages that may send it requests.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace overfly::net {

/// Host and port of a URL. The host is in lower case, an IPv6 address without its brackets.
struct Authority {
  std::string host;
  std::uint16_t port = 0;
  bool operator==(const Authority&) const = default;
};

/// Parses "host", "host:port" or "[address]:port". Empty for anything else.
[[nodiscard]] std::optional<Authority> parse_authority(std::string_view text,
                                                       std::uint16_t port_if_absent);

/// localhost, *.localhost, 127.0.0.0/8 and ::1.
[[nodiscard]] bool is_loopback_host(const std::string& host);

/// Protects against DNS rebinding: a page whose name is made to resolve to this machine has the
/// same origin as this server in the browser. Only the Host header, which contains that name, shows
/// the difference.
class AllowedHosts {
 public:
  /// @param names  names and addresses in addition to those always allowed: loopback names, the
  ///               machine's host name, and the local address of a connection
  explicit AllowedHosts(const std::vector<std::string>& names);

  /// Errors: kInvalidArgument for text that is not a plain host name or address.
  [[nodiscard]] static Status check_name(const std::string& name);

  /// @param host  from a Host header or an Origin
  /// @param local_address  of the connection. As a host it involves no name resolution, so it
  ///                       cannot be a rebound name
  [[nodiscard]] bool allows(const std::string& host, const std::string& local_address) const;

  /// True for a request without an Origin (not from a browser), from a page of the requested
  /// address, or from a page under another name of this server at the same port.
  /// @param host_header  must be allowed
  [[nodiscard]] bool allows_origin(const std::string& origin,
                                   const std::string& host_header,
                                   const std::string& local_address) const;

 private:
  std::set<std::string> names_;
};

}  // namespace overfly::net
