// Which web pages may talk to this server.
#pragma once

#include <string>

namespace overfly::net {

/// The host of "host:port", "[::1]:port" or "http://host:port", in lower case, without brackets.
[[nodiscard]] std::string host_of(const std::string& host_or_origin);
/// localhost, *.localhost, 127.0.0.0/8 and ::1.
[[nodiscard]] bool is_loopback_host(const std::string& host);

/// True for a request without an Origin (no browser), from a page of the same host, or from a
/// page of this machine (a development server on another port).
[[nodiscard]] bool origin_allowed(const std::string& origin, const std::string& host_header);

/// A server that listens on loopback only is asked for by a loopback name: any other Host is a
/// foreign name that was made to resolve to this machine (DNS rebinding).
[[nodiscard]] bool host_allowed(const std::string& host_header, const std::string& listen_address);

}  // namespace overfly::net
