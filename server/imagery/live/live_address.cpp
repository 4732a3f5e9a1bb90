#include "server/imagery/live/live_address.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>

namespace overfly::server {
namespace {

constexpr std::size_t kLongestAddress = 1024;
constexpr const char* kUsualLcmUrl = "udpm://239.255.76.67:7667?ttl=0";
constexpr const char* kUsualMaster = "http://127.0.0.1:11311";

bool is_printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 0x7F; });
}

bool is_numeric_host(const std::string& host) {
  in_addr v4{};
  in6_addr v6{};
  if (host == "localhost") return true;
  if (host.starts_with('[') && host.ends_with(']')) {
    return ::inet_pton(AF_INET6, host.substr(1, host.size() - 2).c_str(), &v6) == 1;
  }
  return ::inet_pton(AF_INET, host.c_str(), &v4) == 1;
}

bool is_port(std::string_view text) {
  std::uint32_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc() && end == text.data() + text.size() && port >= 1 && port <= 65535;
}

/// Host and port of "HOST", "HOST:PORT" or "[ADDRESS]:PORT".
bool is_authority(std::string_view text) {
  const std::size_t bracket = text.find(']');
  const std::size_t colon = text.find(':', bracket == std::string_view::npos ? 0 : bracket);
  if (!is_numeric_host(std::string(text.substr(0, colon)))) return false;
  return colon == std::string_view::npos || is_port(text.substr(colon + 1));
}

/// "SCHEME://[USER:PASSWORD@]HOST[:PORT][/PATH]".
std::optional<LiveAddress> network_camera(LiveKind kind,
                                          std::string_view scheme,
                                          std::string_view text) {
  const std::string_view rest = text.substr(scheme.size());
  const std::size_t path = std::min(rest.find_first_of("/?"), rest.size());
  const std::size_t at = rest.substr(0, path).rfind('@');
  const std::size_t host = at == std::string_view::npos ? 0 : at + 1;
  if (!is_authority(rest.substr(host, path - host))) return std::nullopt;
  return LiveAddress{
      kind, std::string(scheme) + std::string(rest.substr(host)), std::string(text), ""};
}

std::optional<LiveAddress> device(std::string_view path) {
  if (!path.starts_with("/dev/") || path.find("..") != std::string_view::npos) return std::nullopt;
  return LiveAddress{LiveKind::kV4l2, "v4l2:" + std::string(path), std::string(path), ""};
}

bool is_topic(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '/';
  });
}

std::optional<LiveAddress> topic(LiveKind kind, std::string_view text, const char* usual_url) {
  const std::string scheme = kind == LiveKind::kLcm ? "lcm:" : "ros1:";
  const std::size_t at = text.find('@');
  const std::string_view name = text.substr(0, at);
  if (!is_topic(name)) return std::nullopt;
  const std::string url =
      at == std::string_view::npos ? usual_url : std::string(text.substr(at + 1));
  return LiveAddress{kind, scheme + std::string(name) + "@" + url, url, std::string(name)};
}

std::optional<LiveAddress> address_from(std::string_view text) {
  if (text.starts_with("rtsp://")) return network_camera(LiveKind::kRtsp, "rtsp://", text);
  if (text.starts_with("http://")) return network_camera(LiveKind::kHttp, "http://", text);
  if (text.starts_with("v4l2:")) return device(text.substr(5));
  if (text.starts_with("lcm:")) return topic(LiveKind::kLcm, text.substr(4), kUsualLcmUrl);
  if (text.starts_with("ros1:")) return topic(LiveKind::kRos1, text.substr(5), kUsualMaster);
  return std::nullopt;
}

/// The text as a message may repeat it.
std::string without_password(std::string_view text) {
  const std::size_t begin = text.find("://");
  const std::size_t at = text.rfind('@');
  const bool topic = text.starts_with("lcm:") || text.starts_with("ros1:");
  if (topic || at == std::string_view::npos) return std::string(text.substr(0, 200));
  const std::size_t kept = begin == std::string_view::npos || begin > at ? 0 : begin + 3;
  return std::string(text.substr(0, kept)) + "..." + std::string(text.substr(at, 200));
}

}  // namespace

Result<LiveAddress> parse_live_address(std::string_view text, const std::string& field) {
  const bool sane = text.size() <= kLongestAddress && is_printable(text);
  std::optional<LiveAddress> address = sane ? address_from(text) : std::nullopt;
  if (address) return std::move(*address);
  return Error{ErrorCode::kInvalidArgument,
               field + " = " + without_password(text) +
                   ": must be rtsp://HOST[:PORT]/PATH, http://HOST[:PORT]/PATH, v4l2:/dev/videoN, "
                   "lcm:CHANNEL[@URL] or ros1:TOPIC[@URI], HOST a numeric address or localhost"};
}

}  // namespace overfly::server
