#include "server/net/http/allowed_hosts.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/ip/address.hpp>
#include <charconv>

namespace overfly::net {
namespace {

constexpr std::uint16_t kHttpPort = 80;
constexpr std::uint16_t kHttpsPort = 443;
constexpr std::size_t kMaxHostCharacters = 255;  ///< of a name: RFC 1035, section 2.3.4

std::string lower(std::string_view text) {
  std::string lowered(text);
  std::transform(lowered.begin(), lowered.end(), lowered.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return lowered;
}

bool is_name(const std::string& host) {
  constexpr const char* kCharacters = "abcdefghijklmnopqrstuvwxyz0123456789-._";
  return !host.empty() && host.size() <= kMaxHostCharacters &&
         host.find_first_not_of(kCharacters) == std::string::npos;
}

/// An address in its canonical form; empty if the text is not an address.
std::string canonical_address(const std::string& text) {
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(text, error);
  if (error) return {};
  if (address.is_v6() && address.to_v6().is_v4_mapped()) {
    return boost::asio::ip::make_address_v4(boost::asio::ip::v4_mapped, address.to_v6())
        .to_string();
  }
  return address.to_string();
}

std::optional<std::uint16_t> parse_port(std::string_view text) {
  std::uint16_t port = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, port);
  return error == std::errc() && rest == end ? std::optional<std::uint16_t>(port) : std::nullopt;
}

/// "http://host:port" or "https://host:port". If host_header has no port, the default port of the
/// same scheme applies.
struct SchemeOrigin {
  Authority authority;
  std::uint16_t scheme_port = kHttpPort;
};

std::optional<SchemeOrigin> parse_origin(std::string_view origin) {
  SchemeOrigin parsed;
  if (origin.starts_with("http://")) {
    origin.remove_prefix(7);
  } else if (origin.starts_with("https://")) {
    origin.remove_prefix(8);
    parsed.scheme_port = kHttpsPort;
  } else {
    return std::nullopt;
  }
  auto authority = parse_authority(origin, parsed.scheme_port);
  if (!authority) return std::nullopt;
  parsed.authority = std::move(*authority);
  return parsed;
}

std::string machine_name() {
  std::array<char, kMaxHostCharacters + 2> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? lower(name.data()) : std::string();
}

}  // namespace

std::optional<Authority> parse_authority(std::string_view text, std::uint16_t port_if_absent) {
  Authority authority;
  std::string_view rest;
  if (text.starts_with('[')) {
    const std::size_t close = text.find(']');
    if (close == std::string_view::npos) return std::nullopt;
    authority.host = canonical_address(lower(text.substr(1, close - 1)));
    if (authority.host.empty()) return std::nullopt;
    rest = text.substr(close + 1);
  } else {
    const std::size_t colon = std::min(text.find(':'), text.size());
    authority.host = lower(text.substr(0, colon));
    if (!is_name(authority.host)) return std::nullopt;
    rest = text.substr(colon);
  }
  authority.port = port_if_absent;
  if (rest.empty()) return authority;
  const auto port = rest.starts_with(':') ? parse_port(rest.substr(1)) : std::nullopt;
  if (!port) return std::nullopt;
  authority.port = *port;
  return authority;
}

bool is_loopback_host(const std::string& host) {
  if (host == "localhost" || host.ends_with(".localhost")) return true;
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(host, error);
  return !error && address.is_loopback();
}

AllowedHosts::AllowedHosts(const std::vector<std::string>& names) {
  if (std::string name = machine_name(); is_name(name)) names_.insert(std::move(name));
  for (const std::string& name : names) {
    const std::string address = canonical_address(name);
    names_.insert(address.empty() ? lower(name) : address);
  }
}

Status AllowedHosts::check_name(const std::string& name) {
  if (is_name(lower(name)) || !canonical_address(name).empty()) return {};
  return Error{ErrorCode::kInvalidArgument,
               "allowed host = " + name +
                   ": must be a host name or an address, without scheme, port and path"};
}

bool AllowedHosts::allows(const std::string& host, const std::string& local_address) const {
  if (is_loopback_host(host) || names_.contains(host)) return true;
  const std::string address = canonical_address(host);
  return !address.empty() &&
         (names_.contains(address) || address == canonical_address(local_address));
}

bool AllowedHosts::allows_origin(const std::string& origin,
                                 const std::string& host_header,
                                 const std::string& local_address) const {
  if (origin.empty()) return true;
  const auto from = parse_origin(origin);
  if (!from) return false;
  const auto host = parse_authority(host_header, from->scheme_port);
  if (!host || from->authority.port != host->port) return false;
  return from->authority.host == host->host || allows(from->authority.host, local_address);
}

}  // namespace overfly::net
