#include "server/net/origin.hpp"

#include <algorithm>

namespace overfly::net {

std::string host_of(const std::string& host_or_origin) {
  std::string host = host_or_origin;
  if (const std::size_t scheme = host.find("://"); scheme != std::string::npos) {
    host = host.substr(scheme + 3);
  }
  host = host.substr(0, host.find('/'));
  if (!host.empty() && host.front() == '[') {
    const std::size_t close = host.find(']');
    host = close == std::string::npos ? std::string() : host.substr(1, close - 1);
  } else if (std::count(host.begin(), host.end(), ':') == 1) {
    host = host.substr(0, host.find(':'));
  }
  std::transform(host.begin(), host.end(), host.begin(), [](unsigned char c) {
    return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  });
  return host;
}

bool is_loopback_host(const std::string& host) {
  if (host == "localhost" || host.ends_with(".localhost") || host == "::1") return true;
  const bool numeric = host.find_first_not_of("0123456789.") == std::string::npos;
  return numeric && host.starts_with("127.") && std::count(host.begin(), host.end(), '.') == 3;
}

bool origin_allowed(const std::string& origin, const std::string& host_header) {
  if (origin.empty()) return true;
  const std::string host = host_of(origin);
  return !host.empty() && (host == host_of(host_header) || is_loopback_host(host));
}

bool host_allowed(const std::string& host_header, const std::string& listen_address) {
  if (host_header.empty() || !is_loopback_host(listen_address)) return true;
  return is_loopback_host(host_of(host_header));
}

}  // namespace overfly::net
