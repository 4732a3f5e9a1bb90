#include "flight/mavlink/link/link_address.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "core/text/printable_text.hpp"

namespace overfly::flight::mavlink {
namespace {

struct KindName {
  LinkKind kind;
  std::string_view prefix;
};

/// A prefix that begins with another one stands before it.
constexpr std::array<KindName, 5> kKindNames = {{{LinkKind::kUdpListen, "udp-listen:"},
                                                 {LinkKind::kUdp, "udp:"},
                                                 {LinkKind::kTcpListen, "tcp-listen:"},
                                                 {LinkKind::kTcp, "tcp:"},
                                                 {LinkKind::kSerial, "serial:"}}};

/// The rates that termios has a constant for and autopilots use.
constexpr std::array<std::uint32_t, 14> kBaudRates = {9600,
                                                      19200,
                                                      38400,
                                                      57600,
                                                      115200,
                                                      230400,
                                                      460800,
                                                      500000,
                                                      576000,
                                                      921600,
                                                      1000000,
                                                      1500000,
                                                      2000000,
                                                      3000000};

constexpr std::size_t kMaxAddressLength = 256;

std::optional<std::uint32_t> whole_number(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || failure != std::errc{} || end != text.data() + text.size()) {
    return std::nullopt;
  }
  return value;
}

bool is_numeric_host(const std::string& host) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  const int family = host.find(':') == std::string::npos ? AF_INET : AF_INET6;
  return ::inet_pton(family, host.c_str(), bytes.data()) == 1;
}

}  // namespace

std::string LinkAddress::text() const {
  const auto* const name = std::find_if(kKindNames.begin(),
                                        kKindNames.end(),
                                        [&](const KindName& each) { return each.kind == kind; });
  const std::string prefix(name->prefix);
  if (kind == LinkKind::kSerial) return prefix + device + ":" + std::to_string(baud_rate);
  const bool six = host.find(':') != std::string::npos;
  return prefix + (six ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

Result<LinkAddress> parse_link_address(std::string_view text, const std::string& field) {
  const auto rejected = [&](const std::string& why) {
    const std::string_view shown = text.substr(0, kMaxAddressLength);
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(shown.data()), shown.size());
    return Error{ErrorCode::kInvalidArgument, field + " = '" + printable_text(bytes) + "': " + why};
  };
  if (text.size() > kMaxAddressLength) {
    return rejected("must have at most " + std::to_string(kMaxAddressLength) + " characters");
  }
  const auto* const name =
      std::find_if(kKindNames.begin(), kKindNames.end(), [&](const KindName& each) {
        return text.starts_with(each.prefix);
      });
  const std::size_t colon = text.rfind(':');
  if (name == kKindNames.end() || colon < name->prefix.size()) {
    return rejected(
        "must be udp-listen:HOST:PORT, udp:HOST:PORT, tcp-listen:HOST:PORT, tcp:HOST:PORT or "
        "serial:DEVICE:BAUD");
  }
  LinkAddress address;
  address.kind = name->kind;
  const std::string place(text.substr(name->prefix.size(), colon - name->prefix.size()));
  const std::optional<std::uint32_t> number = whole_number(text.substr(colon + 1));
  if (address.kind == LinkKind::kSerial) {
    if (place.size() < 2 || place[0] != '/') {
      return rejected("the device must be an absolute path such as /dev/ttyUSB0");
    }
    if (place.find('\0') != std::string::npos) return rejected("the device has a zero byte");
    if (!number || std::find(kBaudRates.begin(), kBaudRates.end(), *number) == kBaudRates.end()) {
      std::string rates;
      for (const std::uint32_t rate : kBaudRates) {
        rates += (rates.empty() ? "" : ", ") + std::to_string(rate);
      }
      return rejected("the baud rate must be one of " + rates);
    }
    address.device = place;
    address.baud_rate = *number;
    return address;
  }
  const bool listens = address.kind == LinkKind::kUdpListen || address.kind == LinkKind::kTcpListen;
  const std::uint32_t least_port = listens ? 0 : 1;
  if (!number || *number < least_port || *number > 65535) {
    return rejected("the port must be in [" + std::to_string(least_port) + ", 65535]");
  }
  address.port = static_cast<std::uint16_t>(*number);
  const bool bracketed = place.size() > 2 && place.front() == '[' && place.back() == ']';
  address.host = bracketed ? place.substr(1, place.size() - 2) : place;
  if (address.host == "localhost") address.host = "127.0.0.1";
  const bool six = address.host.find(':') != std::string::npos;
  if (six != bracketed || !is_numeric_host(address.host)) {
    return rejected("the host must be a numeric address (IPv6 in brackets) or localhost");
  }
  return address;
}

}  // namespace overfly::flight::mavlink
