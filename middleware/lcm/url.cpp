#include "middleware/lcm/url.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>
#include <set>
#include <string_view>

#include "middleware/lcm/network.hpp"

namespace overfly::lcm {
namespace {

/// Two debug images of 1280 x 960 RGB with overhead.
constexpr std::int64_t kWantedReceiveBufferBytes = std::int64_t{8} << 20U;

const std::map<std::string, std::set<std::string>> kOptionsOfProvider = {
    {"udpm", {"recv_buf_size", "ttl"}},
    {"memq", {}},
    {"file", {"mode", "speed", "start_timestamp"}},
};

std::optional<std::int64_t> integer_from(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, failure] = std::from_chars(text.begin(), text.end(), value);
  if (failure != std::errc{} || end != text.end()) return std::nullopt;
  return value;
}

Error bad_url(const std::string& url, const std::string& what) {
  return {ErrorCode::kInvalidArgument, "LCM URL " + url + ": " + what};
}

Status check_integer(const std::string& text,
                     const Url& url,
                     const std::string& name,
                     std::int64_t from,
                     std::int64_t to) {
  const auto found = url.options.find(name);
  if (found == url.options.end()) return {};
  const auto value = integer_from(found->second);
  if (value && *value >= from && *value <= to) return {};
  return bad_url(text,
                 name + " = " + found->second + ": must be in [" + std::to_string(from) + ", " +
                     std::to_string(to) + "]");
}

Status check_multicast(const std::string& text, const Url& url) {
  in_addr address{};
  if (inet_pton(AF_INET, url.address().c_str(), &address) != 1 ||
      !IN_MULTICAST(ntohl(address.s_addr))) {
    return bad_url(text, "address " + url.address() + ": must be in 224.0.0.0 to 239.255.255.255");
  }
  const std::size_t colon = url.network.find(':');
  if (colon != std::string::npos && colon + 1 < url.network.size()) {
    const std::string port = url.network.substr(colon + 1);
    const auto value = integer_from(port);
    if (!value || *value < 1 || *value > 65535) {
      return bad_url(text, "port " + port + ": must be in [1, 65535]");
    }
  }
  if (Status status = check_integer(text, url, "ttl", 0, 255); !status) return status;
  return check_integer(text, url, "recv_buf_size", 1, INT32_MAX);
}

Status check_url(const std::string& text, const Url& url) {
  const auto provider = kOptionsOfProvider.find(url.provider);
  if (provider == kOptionsOfProvider.end()) {
    return bad_url(text, "provider " + url.provider + ": must be udpm, memq or file");
  }
  for (const auto& [name, value] : url.options) {
    if (!provider->second.contains(name)) {
      return bad_url(text, "option " + name + ": " + url.provider + " does not support it");
    }
  }
  if (url.provider == "udpm") return check_multicast(text, url);
  if (url.provider == "memq" && !url.network.empty()) {
    return bad_url(text, "network " + url.network + ": must be empty for memq");
  }
  if (url.provider == "file" && url.network.empty())
    return bad_url(text, "the path of the log is missing");
  return {};
}

}  // namespace

std::string Url::text() const {
  std::string text = provider + "://" + network;
  char separator = '?';
  for (const auto& [name, value] : options) {
    text += separator + name + "=" + value;
    separator = '&';
  }
  return text;
}

std::string Url::address() const {
  std::string address = network.substr(0, network.find(':'));
  return address.empty() ? kAddress : address;
}

int Url::port() const {
  const std::size_t colon = network.find(':');
  if (colon == std::string::npos) return kPort;
  return static_cast<int>(integer_from(network.substr(colon + 1)).value_or(kPort));
}

Result<Url> parse_url(const std::string& text) {
  const std::size_t scheme_end = text.find("://");
  if (scheme_end == std::string::npos) return bad_url(text, "must be PROVIDER://NETWORK");
  Url url;
  url.provider = text.substr(0, scheme_end);
  std::string rest = text.substr(scheme_end + 3);
  const std::size_t question = rest.find('?');
  url.network = rest.substr(0, question);
  while (question != std::string::npos && rest.size() > question + 1) {
    const std::size_t last = rest.find_last_of("?&");
    const std::string option = rest.substr(last + 1);
    const std::size_t equals = option.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == option.size()) {
      return bad_url(text, "option \"" + option + "\": must be NAME=VALUE");
    }
    if (!url.options.emplace(option.substr(0, equals), option.substr(equals + 1)).second) {
      return bad_url(text, "option " + option.substr(0, equals) + ": given twice");
    }
    rest.resize(last);
  }
  if (Status status = check_url(text, url); !status) return status.error();
  return url;
}

Url with_receive_buffer(Url url) {
  if (url.provider != "udpm") return url;
  // LCM writes a warning to stderr if the kernel grants less than requested.
  const std::int64_t size = std::clamp(
      largest_receive_buffer_bytes(), kSmallestReceiveBufferBytes, kWantedReceiveBufferBytes);
  url.options.emplace("recv_buf_size", std::to_string(size));
  return url;
}

std::int64_t largest_receive_buffer_bytes() {
  std::int64_t bytes = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> bytes;
  return bytes;
}

}  // namespace overfly::lcm
